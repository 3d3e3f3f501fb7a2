#include <loomlink/store/reach.hpp>

#include <string>

namespace weave::loomlink {

namespace {

std::string place_of(Lost when) {
    return when == Lost::before ? "the store is out of reach" : "the store went while it recorded";
}

}  // namespace

Error lost_store(Lost when, const Error& cause) {
    return system_fault(cause.text(), place_of(when));
}

std::optional<Lost> lost_of(const Error& error) {
    for (const Lost when : {Lost::before, Lost::in_commit})
        if (error.code == ErrorCode::system && error.where == place_of(when)) return when;
    return std::nullopt;
}

}  // namespace weave::loomlink
