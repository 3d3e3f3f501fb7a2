#include <loomlink/workflow/caller.hpp>

#include <algorithm>

namespace weave::loomlink {

bool Caller::is(PersonRole role) const {
    return std::find(roles.begin(), roles.end(), role) != roles.end();
}

bool Caller::reads_designs() const {
    return is(PersonRole::designer) || is(PersonRole::approver) || is(PersonRole::engineer);
}

Caller caller_of(const Person& person) {
    return {person.id, person.login, person.full_name, person.roles};
}

const char* role_word(PersonRole role) {
    return role == PersonRole::administrator ? "admin" : word(role);
}

std::optional<PersonRole> parse_role(const std::string& text) {
    for (const PersonRole role : {PersonRole::designer, PersonRole::approver, PersonRole::operator_,
                                  PersonRole::engineer, PersonRole::administrator})
        if (text == role_word(role)) return role;
    return {};
}

}  // namespace weave::loomlink
