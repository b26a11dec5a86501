#include "filters/stop_request.hpp"

namespace beamid::filters {
namespace {

thread_local const std::atomic<bool>* stop_asked = nullptr;

}  // namespace

StopRequest::StopRequest(const std::atomic<bool>& asked) : before_(stop_asked) {
  stop_asked = &asked;
}

StopRequest::~StopRequest() {
  stop_asked = before_;
}

void heed_stop_request() {
  if (stop_asked != nullptr && *stop_asked) throw Stopped();
}

}  // namespace beamid::filters
