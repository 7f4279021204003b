// Commands of this program that the window runs beside itself.
#pragma once

#include <string>
#include <vector>

#include "vpe/app/cli/subprocess.h"
#include "vpe/window/workers/job.h"

namespace vpe::app {

// Runs a command as a process of its own and reads its progress from its messages. Stopped, it ends as with
// Ctrl-C: finished frames of films are kept. The destructor stops it and waits for its end.
class CommandJob : public window::Job {
 public:
  // Starts `program` with words as arguments. Throws std::runtime_error with the system's message.
  CommandJob(const std::string& program, const std::vector<std::string>& words);
  ~CommandJob() override;

  window::JobState state() override;
  void stop() override { process_.interrupt(); }

 private:
  Subprocess process_;
};

// Returns what the messages of a command say of its progress: the last line that is not blank, and the percentage
// in it. Pure.
window::JobState progress_of(const std::string& messages);

}  // namespace vpe::app
