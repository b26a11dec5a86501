// A long run that its caller wants to end.
#pragma once

#include <atomic>

namespace beamid::filters {

/// Thrown by a run that was asked to stop. No std::exception: nobody takes it for a failure of the filter.
struct Stopped {};

/// While it lives, run() in this thread looks at `asked` every few samples and throws Stopped where it is
/// set.
/// @param asked lives longer
class StopRequest {
 public:
  explicit StopRequest(const std::atomic<bool>& asked);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

 private:
  const std::atomic<bool>* before_;
};

/// @throws Stopped where this thread was asked to
void heed_stop_request();

}  // namespace beamid::filters
