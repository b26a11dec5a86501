#include "tests/apps/run_command.hpp"

namespace beamid::apps {

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + " cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

Workplace::Workplace() {
  std::string name = (fs::temp_directory_path() / "beamid_apps_XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  root_ = name;
  fs::create_directory(folder());
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(root_, ignored);
}

void Workplace::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder() / name, std::ios::binary) << text;
}

Outcome Workplace::run(const std::string& words, const std::string& environment) const {
  const fs::path out = root_ / "stdout", err = root_ / "stderr";
  const std::string line = "cd '" + folder().string() + "' && " + environment + " '" BEAMID_COMMAND "' " +
                           words + " >'" + out.string() + "' 2>'" + err.string() + "' </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
}

std::vector<std::string> Workplace::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder()))
    names.push_back(entry.path().lexically_relative(folder()).string());
  std::sort(names.begin(), names.end());
  return names;
}

nlohmann::json json_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

fs::path source(const std::string& path) {
  return fs::path(BEAMID_SOURCE_DIR) / path;
}

}  // namespace beamid::apps
