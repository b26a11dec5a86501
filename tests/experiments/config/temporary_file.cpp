#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments {

TemporaryFile::TemporaryFile(const std::string& name, const std::string& content)
    : folder_(std::filesystem::temp_directory_path() / ("beamid_input_" + std::to_string(::getpid()))),
      path_(folder_ / name) {
  std::filesystem::create_directories(folder_);
  std::ofstream(path_, std::ios::binary) << content;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  std::filesystem::remove(folder_, ignored);
}

}  // namespace beamid::experiments
