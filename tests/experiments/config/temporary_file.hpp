// Files for tests of readers.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// A file of this content for as long as the object lives.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
};

/// The message of the InputError that `action` throws, with the folders taken off the file's name.
template <class Action>
std::string input_error_of(const TemporaryFile& file, Action action) {
  try {
    action();
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string folder = file.path().parent_path().string() + "/";
    for (std::size_t at; (at = message.find(folder)) != std::string::npos;) message.erase(at, folder.size());
    return message;
  }
  return "no error";
}

}  // namespace beamid::experiments
