#pragma once

#include <string>

namespace weave::loomlink {

/// The word that the log has for what a route does, such as `revision.approved` of `revision.approve`: a refusal is
/// found by one word, whether the gate sent it away or the workflow refused it. The route's own name where what it
/// does is not logged.
std::string deed_of_route(const std::string& route);

}  // namespace weave::loomlink
