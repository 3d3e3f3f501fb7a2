#include <loomlink/service/visitor.hpp>

#include <algorithm>

namespace weave::loomlink {

bool Access::allows(const Caller& caller) const {
    if (kind == Kind::anyone) return true;
    if (caller.id == 0) return false;
    return kind == Kind::signed_in ||
           std::any_of(roles.begin(), roles.end(), [&](PersonRole role) { return caller.is(role); });
}

namespace access {

Access anyone() {
    return {Access::Kind::anyone};
}

Access signed_in() {
    return {Access::Kind::signed_in};
}

Access readers() {
    return only({PersonRole::designer, PersonRole::approver, PersonRole::engineer});
}

Access readers_and_operators() {
    return only({PersonRole::designer, PersonRole::approver, PersonRole::engineer, PersonRole::operator_});
}

Access only(std::set<PersonRole> roles) {
    return {Access::Kind::some, std::move(roles)};
}

}  // namespace access

}  // namespace weave::loomlink
