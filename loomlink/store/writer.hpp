#pragma once

#include <weave/core/result.hpp>

#include <loomlink/store/reader.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// The largest object.
inline constexpr std::size_t largest_object = std::size_t{256} << 20;

/// Changes within one write, which also sees what it changed so far. Refused is what the rules of the
/// database refuse, in its words: they hold whatever the caller believes. Nothing that is kept can be changed
/// or removed.
class Writer : public Reader {
  public:
    using Reader::Reader;

    // The log
    /// Adds a record: its number, link and tree are made here. Refused: a statement of another site.
    Result<Seq> append(const Statement& statement, const std::optional<RecordSignature>& signature = {});
    /// Keeps a signed head. Refused where its size and root are not those of the log.
    Status add_head(const SignedTreeHead& head);

    // Objects
    /// Keeps bytes under their hash; what is kept already costs nothing.
    Result<Hash> put_object(std::string_view bytes);

    // People
    Result<Id> add_person(const Person& person);
    /// Sets name, roles, activity and password hash of the person `id`; the login name stays.
    Status update_person(const Person& person);
    Status add_key(const PersonKey& key);
    /// The same key sealed under another password. Refused: a revoked one.
    Status reseal_key(const std::string& id, const std::string& sealed);
    Status revoke_key(const std::string& id, Seq event);
    Status add_session(const Session& session);
    Status end_session(const Hash& token);
    Status end_sessions(Id person);
    Status drop_expired_sessions(const std::string& now);
    /// Records the answer to a request, so that its repetition is answered the same and done once.
    Status record_answer(const std::string& request, Id person, const std::string& answer);

    // The site
    Status add_invitation(const Invitation& invitation);
    /// Refused: an invitation that was used.
    Status use_invitation(const Hash& code, Seq event);
    Status add_policy(const std::string& text, Seq event);
    /// Keeps the next trust document, which must be an object.
    Status add_trust(std::int64_t number, const Hash& object, Seq event);

    // Designs
    Result<Id> add_design(const std::string& name, Seq event);
    /// Adds a draft; see Revision for what is given. Parents must exist, the document must be an object.
    Result<Revision> add_revision(const Revision& revision);
    /// Points a branch at a revision of its design. Refused where its head is not `expected` (none: the
    /// branch is new): somebody else was first.
    Status move_branch(const Branch& to, std::optional<Id> expected);
    Status set_state(Id revision, RevisionState state, Seq event);
    Status add_decision(const Decision& decision);
    Status add_waiver(const Waiver& waiver);
    Result<Id> add_evidence(const Evidence& evidence);
    Status add_comment(const Comment& comment);

    // Looms and releases
    Result<Id> add_loom(const std::string& name, Seq event);
    /// The next version of a loom's profile, which must be an object.
    Result<std::int64_t> add_profile(Id loom, const Hash& object, Seq event);
    Status allow_operator(Id loom, Id person, Seq event);
    Status disallow_operator(Id loom, Id person);
    /// Adds a prepared release; see Release for what is given.
    Result<Release> add_release(const Release& release);
    Status sign_release(Id release, const ReleaseSignature& signature);
    Status set_release_state(Id release, ReleaseStage state, Seq event);
    Status set_bookmark(const Bookmark& bookmark);
    Status add_fault(const FaultReport& fault);
    Status add_loaded(const Loaded& loaded);

  private:
    [[nodiscard]] Result<Id> object_id(const Hash& hash);
};

/// SHA-256 of the canonical JSON of what a revision is: `design` and `author` by name, `parents` by hash,
/// `at`, `message`, and the SHA-256 of document, design, scene and card.
Hash revision_hash(const Revision& revision, const std::string& design, const std::string& author,
                   const std::vector<Hash>& parents);

}  // namespace weave::loomlink
