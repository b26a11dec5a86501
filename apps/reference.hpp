// Sources in full words.
#pragma once

#include <string>
#include <vector>

namespace beamid::apps {

/// docs/references.md.
extern const char* const references_text;

/// "[julier2004], [hairer1996, ch. IV.3]" as "S. J. Julier, ...: Unscented filtering ..." and
/// "... Springer, Berlin 1996, ch. IV.3": each key as docs/references.md spells it out, without its emphasis.
/// A source that names no key known there, as a user's own, is kept as it is.
std::vector<std::string> full_references(const std::string& source);

}  // namespace beamid::apps
