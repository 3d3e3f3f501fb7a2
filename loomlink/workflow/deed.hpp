#pragma once

#include <weave/core/json.hpp>
#include <weave/keys/key.hpp>

#include <string>
#include <utility>
#include <vector>

namespace weave::loomlink {

/// A step that is about to be taken: what the log will say of it.
struct Deed {
    std::string kind;       ///< such as `revision.approved`
    std::string subject{};  ///< what it is done to; may be empty
    std::string reason{};
    Json data = Json::object();
    bool is_signed = false;
    bool told_once = false;  ///< the answer holds a secret: it is not kept, a repetition is refused
    /// What the same password signs beside the statement.
    std::vector<std::pair<Purpose, std::string>> also{};
};

}  // namespace weave::loomlink
