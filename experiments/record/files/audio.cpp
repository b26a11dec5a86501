// Sound files, WAV, AIFF and FLAC, as microphone inputs and vibration loggers write them [libsndfile].
#include <dlfcn.h>
#include <fmt/format.h>
#include <sndfile.h>

#include <memory>

#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

/// libsndfile, loaded when the first sound file is read: no other command needs it, nor the libraries that it
/// needs.
class SoundLibrary {
 public:
  explicit SoundLibrary(const std::filesystem::path& file)
      : library_(dlopen("libsndfile.so.1", RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr)
      throw InputError(
          {file.string()},
          "is a sound file, and libsndfile is not installed; apt-get install libsndfile1, or save as CSV");
    find(open, "sf_open"), find(close, "sf_close"), find(read, "sf_readf_double"),
        find(command, "sf_command"), find(why, "sf_strerror");
  }

  decltype(&sf_open) open = nullptr;
  decltype(&sf_close) close = nullptr;
  decltype(&sf_readf_double) read = nullptr;
  decltype(&sf_command) command = nullptr;
  decltype(&sf_strerror) why = nullptr;

 private:
  template <class Function>
  void find(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library_, name));
    if (function == nullptr) throw std::runtime_error(fmt::format("libsndfile.so.1 has no {}", name));
  }

  void* library_;  // stays loaded: reading again costs nothing then
};

/// Significant digits of a sample: of integers those of full scale.
int digits_of(int format) {
  switch (format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_S8:
    case SF_FORMAT_PCM_U8:
      return 2;
    case SF_FORMAT_PCM_16:
      return 4;
    case SF_FORMAT_DOUBLE:
      return 15;
    default:
      return 7;
  }
}

class AudioReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    const auto kind = [&](std::string_view name, std::string_view form) {
      return beginning.starts_with(name) && beginning.size() > 12 && beginning.substr(8).starts_with(form);
    };
    return kind("RIFF", "WAVE") || kind("RF64", "WAVE") || kind("FORM", "AIF") ||
           beginning.starts_with("fLaC");
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    const SoundLibrary library(file);
    SF_INFO info{};
    const std::unique_ptr<SNDFILE, decltype(library.close)> sound(library.open(file.c_str(), SFM_READ, &info),
                                                                  library.close);
    if (!sound)
      throw InputError(
          {file.string()},
          fmt::format("libsndfile cannot read it: {}; expected WAV, AIFF or FLAC", library.why(nullptr)));
    if (info.frames < 1 || info.channels < 1 || info.samplerate < 1)
      throw InputError({file.string()}, "holds no samples");
    const auto width = static_cast<std::size_t>(info.channels);
    RecordTable table;
    table.file = file.string();
    table.by_people = true;
    table.clock = Clock{0.0, 1.0 / static_cast<double>(info.samplerate)};
    table.columns.resize(width);
    table.precision.assign(width, PrintedPrecision::of_digits(digits_of(info.format)));
    constexpr sf_count_t at_once = 65536;
    std::vector<double> block(static_cast<std::size_t>(at_once) * width);
    sf_count_t frames = 0, read = 0;
    while ((read = library.read(sound.get(), block.data(), at_once)) > 0) {
      for (std::size_t c = 0; c < width; ++c)
        for (std::size_t k = 0; k < static_cast<std::size_t>(read); ++k)
          table.columns[c].push_back(block[k * width + c]);
      frames += read;
    }
    if (frames < info.frames)
      throw InputError(
          {file.string()},
          fmt::format("is cut short: {} samples of the {} that its header states", frames, info.frames));
    table.remarks.push_back(
        fmt::format("A sound file of {} channel{} at {} Hz. Its numbers are shares of full scale, 1: a "
                    "sensor's factor is not in it.",
                    width, width > 1 ? "s" : "", info.samplerate));
    return table;
  }
};

const bool audio_registered = record_reader_registry().add(
    {"audio",
     "sound files, WAV, AIFF, FLAC: a signal for each channel, as shares of full scale, at the file's rate",
     "[libsndfile]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<AudioReader>(); }});

}  // namespace
}  // namespace beamid::experiments
