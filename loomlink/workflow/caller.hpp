#pragma once

#include <loomlink/store/records.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Who asks: a person, as a session names one.
struct Caller {
    Id id = 0;
    std::string login, full_name;
    std::vector<PersonRole> roles;

    [[nodiscard]] bool is(PersonRole role) const;
    /// Whether designs and their revisions are open to this person: all roles but operator and admin alone.
    [[nodiscard]] bool reads_designs() const;
};

Caller caller_of(const Person& person);

/// What every call brings that changes something.
struct Ask {
    std::string request;   ///< an id of the caller's choice, 8 to 64 characters
    std::string password;  ///< typed again for steps that are signed; else empty
};

/// The words of the API for a role: as the store's, but `admin`.
const char* role_word(PersonRole role);
std::optional<PersonRole> parse_role(const std::string& word);

}  // namespace weave::loomlink
