#include <loomlink/store/words.hpp>

namespace weave::loomlink {

const char* word(PersonRole role) {
    return words::roles.at(static_cast<std::size_t>(role));
}
const char* word(RevisionState state) {
    return words::revision_states.at(static_cast<std::size_t>(state));
}
const char* word(DecisionKind kind) {
    return words::decisions.at(static_cast<std::size_t>(kind));
}
const char* word(ReleaseStage state) {
    return words::release_states.at(static_cast<std::size_t>(state));
}

}  // namespace weave::loomlink
