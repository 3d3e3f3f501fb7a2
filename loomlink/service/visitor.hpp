#pragma once

#include <weave/core/result.hpp>

#include <functional>
#include <loomlink/workflow/accounts.hpp>
#include <set>
#include <string>

namespace weave::loomlink {

/// Who sent a request, as far as the gate found out.
struct Visitor {
    SignedIn session;     ///< a caller of id 0: nobody in particular
    std::string token;    ///< the session's
    std::string address;  ///< of the other side
    bool by_cookie = false;  ///< the token came as the page's cookie

    [[nodiscard]] const Caller& caller() const { return session.caller; }
};

/// Who may use a route.
struct Access {
    enum class Kind : std::uint8_t { anyone, signed_in, some } kind = Kind::some;
    std::set<PersonRole> roles{};  ///< of `some`: one of them is enough

    [[nodiscard]] bool allows(const Caller& caller) const;
};

namespace access {
Access anyone();
Access signed_in();
/// Designers, approvers and engineers.
Access readers();
/// Readers, and the operators, each for his or her looms.
Access readers_and_operators();
Access only(std::set<PersonRole> roles);
}  // namespace access

/// Whose session a token is. Denied (`who`) where it is none, has ended, or its person may no longer sign in.
using FindSession = std::function<Result<SignedIn>(const std::string& token)>;

/// Is told of what the gate refuses to somebody who is signed in: the request's id, what was attempted, and
/// why not.
using NoteRefusal = std::function<void(const Caller& caller, const std::string& request, const Deed& attempt,
                                       const Error& error)>;

}  // namespace weave::loomlink
