#pragma once

#include <cstdint>
#include <loomlink/keys/sealed_key.hpp>
#include <loomlink/workflow/desk.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Who a token is, and until when.
struct SignedIn {
    Caller caller;
    std::string csrf, expires;
};

/// People: how they join, sign in and leave; what each may do. Roles are the words of the API. Answers have
/// the members that service/API.md names.
class Accounts {
  public:
    explicit Accounts(Desk& desk) : m_desk(&desk) {}

    /// The invitation of the first administrator, of a site that has nobody yet. Refused later.
    Result<Json> first_invitation();
    /// The same for one more administrator, whoever has joined: for who has the site's own folder in hand, when
    /// no administrator can sign in any more.
    Result<Json> recovery_invitation();
    /// `code`, `expires`. The code is told once.
    Result<Json> invite(const Caller& caller, const Ask& ask, const std::vector<std::string>& roles);
    /// Makes an account with a sealed key of its own, or a new key for one that was reset; answers as log_in.
    Result<Json> join(const std::string& code, const std::string& name, const std::string& full_name,
                      const std::string& password, const std::string& address);

    /// `token`, `csrf`, `expires`, `person`. Refused in the same words and after the same time whether name
    /// or password is wrong; throttled by name and by address.
    Result<Json> log_in(const std::string& name, const std::string& password, const std::string& address);
    Result<Json> log_out(const std::string& token);
    /// Who holds this token; the session goes on from now.
    Result<SignedIn> who(const std::string& token);
    /// `person`, `csrf`, `expires`.
    Result<Json> me(const SignedIn& signed_in);

    /// The key is sealed anew, other sessions end.
    Result<Json> change_password(const Caller& caller, const Ask& ask, const std::string& old_password,
                                 const std::string& new_password);

    /// `people`: of each `name`, `full_name`, `roles`, `active`, `key`.
    Result<Json> people(const Caller& caller);
    Result<Json> set_roles(const Caller& caller, const Ask& ask, const std::string& name,
                           const std::vector<std::string>& roles);
    /// Who is disabled is signed out and cannot sign; the key stays, unless a trust document drops it.
    Result<Json> set_active(const Caller& caller, const Ask& ask, const std::string& name, bool active);
    /// For a lost password: the key is revoked, and the person joins again with a new code. `code`,
    /// `expires`.
    Result<Json> reset(const Caller& caller, const Ask& ask, const std::string& name);

    /// `token`, `expires`: lets the person use simd for so many hours. Told once, and logged with its hash alone.
    Result<Json> access_token(const Caller& caller, const Ask& ask, std::int64_t hours);
    /// `site`, `key`, `public`: by what simd knows the tokens of this site.
    [[nodiscard]] Json access_key() const;

    Result<Json> policy();
    Result<Json> set_policy(const Caller& caller, const Ask& ask, const Json& policy);

  private:
    Result<Json> invite_admin(Json data);
    Result<Json> open_session(const Person& person);
    Result<Json> reseal(const Caller& caller, const Ask& ask, Deed deed, const PersonKey& key,
                        const SealedKey& anew, const std::string& new_password);
    Result<Json> add_invited(const std::string& code, const Person& wish, const std::string& password);

    Desk* m_desk;
};

/// What the API tells of a person to the person: `name`, `full_name`, `roles`, `key`.
Result<Json> person_json(const Reader& reader, const Person& person);

/// Refused unless the caller has the role.
Status need_role(const Caller& caller, PersonRole role);

}  // namespace weave::loomlink
