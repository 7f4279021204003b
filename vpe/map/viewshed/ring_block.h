// Some rings of an octant whose rings lie across the rows of memory, so that rows are read and written in pieces. Private
// to vpe/map/viewshed.
#pragma once

#include <cstddef>
#include <vector>

namespace vpe::map {

inline constexpr int kRingsOfBlock = 16;

// Describes the rings and posts of a block.
struct BlockFrame {
  int first_ring = 1;
  int first_post = 0;
  int posts = 0;
};

// Describes where the post of ring r and number n is: r ring_step + n post_step from the observer's.
struct BlockSteps {
  std::ptrdiff_t ring_step = 0;
  std::ptrdiff_t post_step = 0;
};

// Holds the values of all posts of kRingsOfBlock rings. For one thread.
template <class Value>
class RingBlock {
 public:
  void resize(const BlockFrame& frame) {
    frame_ = frame;
    values_.resize(static_cast<std::size_t>(frame.posts) * kRingsOfBlock);
  }

  // Returns the values of a ring from post `from` on.
  Value* ring(int ring, int from) {
    return values_.data() + (ring - frame_.first_ring) * frame_.posts + (from - frame_.first_post);
  }

  // Reads the posts of the first `rings` rings.
  void read(const Value* observer, const BlockSteps& steps, int rings) {
    for (int post = 0; post < frame_.posts; ++post) {
      const Value* const line = at(observer, steps, post);
      Value* const values = values_.data() + post;
      for (int n = 0; n < rings; ++n) values[n * frame_.posts] = line[n * steps.ring_step];
    }
  }

  // Writes values of a post on the rings `from` up to, but without, `to`, counted from the first.
  void write(Value* observer, const BlockSteps& steps, int post, int from, int to) {
    Value* const line = at(observer, steps, post - frame_.first_post);
    const Value* const values = values_.data() + (post - frame_.first_post);
    for (int n = from; n < to; ++n) line[n * steps.ring_step] = values[n * frame_.posts];
  }

  const BlockFrame& frame() const { return frame_; }

 private:
  template <class Any>
  Any* at(Any* observer, const BlockSteps& steps, int post) const {
    return observer + frame_.first_ring * steps.ring_step + (frame_.first_post + post) * steps.post_step;
  }

  BlockFrame frame_;
  std::vector<Value> values_;
};

}  // namespace vpe::map
