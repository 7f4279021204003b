// Sheets of columns, cast by several threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/column_walk.h"

namespace vpe::voxel {

// Columns side by side that share their rows, and where their ranges go.
struct Sheet {
  Rows rows;
  int columns = 0;
  float* out = nullptr;       // of row 0, column 0
  std::ptrdiff_t stride = 0;  // floats from a row to the next
  bool stream = false;        // see copy_rows()
  // Sets a column's azimuth, its rows [row, row_end), and its part of a fan. Only these rows are written, and
  // those of the columns beside it.
  std::function<void(int column, ColumnGroup& group, int lane, glm::dvec3& azimuth)> set_column;
};

// What a thread works with while a picture is cast.
struct Desk;

class Desks {
 public:
  Desks(const LatticeStore& store, double exaggeration);
  ~Desks();
  Desks(const Desks&) = delete;
  Desks& operator=(const Desks&) = delete;

  // A desk for as long as this lives. Not handed on when it is left by an exception.
  class Use {
   public:
    explicit Use(Desks& desks);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    LatticeShelf& shelf() const;
    Desk& desk() const { return *desk_; }

   private:
    Desks& desks_;
    int thrown_;
    std::unique_ptr<Desk> desk_;
  };

 private:
  const LatticeStore& store_;
  double exaggeration_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Desk>> free_;
};

// Columns of different sheets are cast side by side. Throws paging::PlanetError for tiles that cannot be read.
void cast_sheets(std::span<const Sheet> sheets, const ColumnWalk& walk, Desks& desks, base::ThreadPool& pool);

}  // namespace vpe::voxel
