#include "experiments/results/file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace beamid::experiments {

void write_file(const std::filesystem::path& file, std::string_view text) {
  const auto fail = [&] {
    throw std::runtime_error("cannot write '" + file.string() + "': " + std::strerror(errno));
  };
  std::FILE* const stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) fail();
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const int reason = errno;
  // A full disk often shows only here, when the buffer is flushed.
  const bool closed = std::fclose(stream) == 0;
  if (!written) errno = reason;
  if (!written || !closed) fail();
}

}  // namespace beamid::experiments
