// Watches the reads of remote rasters, so that a program can say what it waits for. A read that a server keeps
// waiting cannot be ended from outside.
#pragma once

#include <functional>
#include <string>

namespace mars {

// Describes a read that goes on.
struct RemoteWait {
  int number = 0;       // differs for all reads of the process
  std::string address;  // GDAL's name of the file
  double seconds = 0;   // since it began, attempts and pauses included
};

// Receives the read that lasts longest, a few times a second, on a thread of its own.
using RemoteWatch = std::function<void(const RemoteWait& wait)>;

// Sets the watch of the process. Without one, reads are not watched.
void set_remote_watch(RemoteWatch watch);

// Registers a read from begin to end, on any thread. Returns its number, which is above 0.
int begin_remote_wait(std::string address);
void end_remote_wait(int number);

}  // namespace mars
