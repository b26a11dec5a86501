// Sound files, through libsndfile [sndfile]: WAV, RF64, AIFF, FLAC, Ogg, CAF.
#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <vector>

#include <needed_library.hpp>
#include "experiments/record/read_apart.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr NeededLibrary sndfile{"libsndfile.so.1", "libsndfile1"};
BEAMID_NEEDED(sndfile, sf_open);
BEAMID_NEEDED(sndfile, sf_strerror);
BEAMID_NEEDED(sndfile, sf_readf_double);
BEAMID_NEEDED(sndfile, sf_close);

/// The channels of a sound file; those of integers in fractions of full scale.
void collect_sound(CollectedSignals& signals) {
  SF_INFO info{};
  SNDFILE* const sound = sf_open(signals.file().c_str(), SFM_READ, &info);
  if (sound == nullptr)
    throw InputError(
        {signals.file(), 0, 0},
        fmt::format("no sound that libsndfile reads ({}); expected WAV, AIFF or FLAC", sf_strerror(nullptr)));
  const auto channels = static_cast<std::size_t>(std::max(info.channels, 0));
  signals.announce("its channels",
                   {channels, static_cast<std::size_t>(std::max<sf_count_t>(info.frames, 0))});
  constexpr sf_count_t at_once = 4096;
  std::vector<std::vector<double>> values(channels);
  std::vector<double> frames(static_cast<std::size_t>(at_once) * channels);
  for (sf_count_t left = info.frames; left > 0;) {
    const sf_count_t count = sf_readf_double(sound, frames.data(), std::min(left, at_once));
    if (count <= 0)
      throw InputError({signals.file(), 0, 0}, fmt::format("{} frames; expected {}, as its header states",
                                                           info.frames - left, info.frames));
    for (std::size_t k = 0; k < static_cast<std::size_t>(count) * channels; ++k)
      values[k % channels].push_back(frames[k]);
    left -= count;
  }
  sf_close(sound);
  const int kind = info.format & SF_FORMAT_SUBMASK;
  const int digits = kind == SF_FORMAT_DOUBLE                               ? 15
                     : kind == SF_FORMAT_PCM_16 || kind == SF_FORMAT_PCM_S8 ? 5
                                                                            : 7;
  for (std::size_t k = 0; k < channels; ++k)
    signals.add(fmt::format("channel_{}", k + 1), "", std::move(values[k]), digits);
  signals.set("sample_rate", info.samplerate);
}

class SoundReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    const std::string_view form = beginning.substr(std::min<std::size_t>(beginning.size(), 8), 4);
    return ((beginning.starts_with("RIFF") || beginning.starts_with("RF64") ||
             beginning.starts_with("RIFX")) &&
            form == "WAVE") ||
           (beginning.starts_with("FORM") && (form == "AIFF" || form == "AIFC")) ||
           beginning.starts_with("fLaC") || beginning.starts_with("OggS") || beginning.starts_with("caff");
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const std::size_t bytes = count_bytes(file, "a sound file");
    RecordTable table =
        read_apart(file.string(), "libsndfile", reading_limits(bytes), collect_sound).table(format);
    table.remarks.emplace_back(
        "A sound file states no unit: its signals are as in the file, integers as fractions of full scale "
        "1.");
    return table;
  }
};

const bool sound_registered = record_reader_registry().add(
    {"sound",
     "WAV, AIFF, FLAC and what else libsndfile reads: a signal for each channel, the rate from the file, "
     "integers as fractions of full scale",
     "[sndfile]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<SoundReader>(); }});

}  // namespace
}  // namespace beamid::experiments
