// Whether what a decay's modes leave is the same motion going on.
#pragma once

#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// Modes of a free decay leave noise, or, where frequency and damping follow the amplitude, motion that dies
/// out with them. Under loads that go on they leave motion at their own frequencies to the end, and it rises
/// at times. So: they leave more than 15 % of the motion; some four periods of it are 1.2 times as large as
/// four before; and at one of them, in the second half of `target` - `reproduced`, the power within three
/// resolutions to either side is 10 times the band's median, and a quarter of the first half's or more. (Of
/// white noise the mean of 7 powers reaches 10 medians with probability 1e-13.)
bool motion_goes_on(const RecordModes& found);

/// Whether a record whose largest reading stands in its second half, from where on it was taken for a decay,
/// moves nearly as much in two periods of the strongest mode before as in two after: a hit or a release
/// begins at once, random vibration comes to its largest and goes.
bool moved_before(const Record& whole, const RecordModes& found);

}  // namespace beamid::experiments
