// The pipe between a process and the child that reads a file for it.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace beamid::experiments {

/// The child's end: numbers and texts as they lie in memory. The child ends where nobody listens.
class PipeSender {
 public:
  explicit PipeSender(int descriptor) : descriptor_(descriptor) {}

  void bytes(const void* from, std::size_t count) const;
  void text(const std::string& text) const;
  template <class Number>
  void number(Number value) const {
    bytes(&value, sizeof value);
  }

 private:
  int descriptor_;
};

/// The parent's end, which it closes. Each of its functions is false where nothing more comes.
class PipeReceiver {
 public:
  PipeReceiver(int descriptor, std::chrono::steady_clock::time_point deadline)
      : descriptor_(descriptor), deadline_(deadline) {}
  ~PipeReceiver();
  PipeReceiver(const PipeReceiver&) = delete;
  PipeReceiver& operator=(const PipeReceiver&) = delete;

  bool bytes(void* to, std::size_t count);
  bool text(std::string& text);  ///< of at most 1 MiB
  template <class Number>
  bool number(Number& value) {
    return bytes(&value, sizeof value);
  }
  bool late() const { return late_; }  ///< the deadline has passed

 private:
  int descriptor_;
  std::chrono::steady_clock::time_point deadline_;
  bool late_ = false;
};

}  // namespace beamid::experiments
