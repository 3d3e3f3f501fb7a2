#pragma once

// What a log tells, kind by kind: the pieces of which retelling.cpp makes a whole.

#include <loomlink/audit/record.hpp>
#include <loomlink/store/records.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace weave::loomlink {

/// A record that is being told. A member that is missing, or is something else, throws; the retelling names
/// the record.
struct Telling {
    const EventRecord& record;

    [[nodiscard]] Seq seq() const { return record.seq; }
    [[nodiscard]] const std::string& actor() const { return record.statement.actor; }
    [[nodiscard]] const std::string& subject() const { return record.statement.subject.value(); }
    [[nodiscard]] const std::string& reason() const { return record.statement.reason.value(); }
    [[nodiscard]] const Json& data(const char* member) const { return record.statement.data.at(member); }
    [[nodiscard]] std::string text(const char* member) const { return data(member).get<std::string>(); }
    [[nodiscard]] std::int64_t number(const char* member) const {
        return data(member).get<std::int64_t>();
    }
};

/// `… by record 17`
std::string by_record(const std::string& what, Seq seq);

/// People, their keys and the codes by which they joined; machines that sign; policies and trust documents.
class ToldPeople {
  public:
    void invited(const Telling& told);
    void joined(const Telling& told);
    void password_changed(const Telling& told);
    void password_rehashed(const Telling& told);
    void reset(const Telling& told);
    void roles_set(const Telling& told);
    void set_active(const Telling& told, bool active);
    void signer_invited(const Telling& told);
    void signer_enrolled(const Telling& told);
    void signer_revoked(const Telling& told);
    void signed_in(const Telling& told);
    void signed_out(const Telling& told);
    void policy_set(const Telling& told);
    void trust_published(const Telling& told);

    /// Whether a key was this person's, and counted, when this record was written.
    [[nodiscard]] bool holds(const std::string& login, const std::string& key) const;
    [[nodiscard]] std::size_t approvals_needed() const { return m_approvals; }
    void add_to(std::vector<KeptThing>& things) const;

  private:
    struct ToldPerson {
        std::string full_name, password_sha256;
        bool active = true;
        std::vector<std::string> roles;  ///< words of the store, sorted
        Seq event = 0;
    };
    struct ToldKey {
        std::string holder;  ///< a person, or a machine
        bool is_person = true;
        std::string public_key;
        std::optional<std::string> sealed_sha256;
        Seq created = 0;
        std::optional<Seq> revoked;
    };
    struct ToldInvitation {
        std::string purpose;
        std::optional<std::string> name;
        std::string roles, expires, code;
        std::optional<Seq> used;
    };
    void add_key(const Telling& told, const std::string& holder, bool is_person);
    void use_code(const Telling& told);
    void end_sessions(const std::string& login);
    void revoke_keys(const std::string& holder, bool is_person, Seq seq);

    std::map<std::string, ToldPerson> m_people;
    std::map<std::string, ToldKey> m_keys;
    std::map<Seq, ToldInvitation> m_invitations;
    std::map<std::string, std::string> m_sessions;  ///< person by the hash of the token
    std::vector<KeptThing> m_papers;
    std::int64_t m_policies = 0;
    std::size_t m_approvals = 1;
};

/// Designs, the graph of their revisions, and what people and simulations said of them.
class ToldDesigns {
  public:
    void added(const Telling& told);
    void saved(const Telling& told);
    void submitted(const Telling& told);
    void changes_requested(const Telling& told);
    /// One more approval, of so many that the policy asks for now.
    void approved(const Telling& told, std::size_t needed);
    void waived(const Telling& told);
    void commented(const Telling& told);
    void evidence_added(const Telling& told);

    /// The looms' side: a revision came to a state by what was done to a release of it.
    void came_to(const std::string& design, std::int64_t number, RevisionState state, Seq seq);
    [[nodiscard]] RevisionState state_of(const std::string& design, std::int64_t number) const;
    void add_to(std::vector<KeptThing>& things) const;

  private:
    struct ToldRevision {
        Hash hash{};
        std::set<std::string> authors, approvals;
        RevisionState state = RevisionState::draft;
        bool was_approved = false;
    };
    /// The revision that a step names by its number and, where the person signed it, by its hash.
    ToldRevision& bound(const Telling& told);
    void decide(const Telling& told, DecisionKind kind);
    void inherit(ToldRevision& revision, const Telling& told) const;

    std::map<std::string, std::vector<ToldRevision>> m_designs;  ///< revision N at N - 1
    std::map<std::pair<std::string, std::string>, std::pair<std::int64_t, Seq>> m_branches;
    std::vector<KeptThing> m_things;
};

/// Looms, their releases, and what operators told.
class ToldLooms {
  public:
    explicit ToldLooms(ToldDesigns& designs) : m_designs(&designs) {}

    void added(const Telling& told);
    void profile_set(const Telling& told);
    void operators_set(const Telling& told);
    void place_kept(const Telling& told);
    void loaded(const Telling& told);
    void fault_reported(const Telling& told);
    void release_made(const Telling& told);
    void release_signed(const Telling& told);
    void release_in_force(const Telling& told);
    void release_withdrawn(const Telling& told);

    void add_to(std::vector<KeptThing>& things) const;

  private:
    struct ToldRelease {
        std::string design;
        std::int64_t revision = 0;
        ReleaseStage stage = ReleaseStage::prepared;
    };
    struct ToldLoom {
        std::int64_t profiles = 0;
        std::map<std::string, Seq> operators;
        std::vector<ToldRelease> releases;  ///< release N at N - 1
    };
    ToldRelease& release(const Telling& told);
    void add_profile(const Telling& told);
    void come_to(const std::string& loom, std::size_t index, ReleaseStage stage, Seq seq);
    /// A revision that no loom has any more comes to `state`.
    void leave_looms(const ToldRelease& release, RevisionState state, Seq seq);

    ToldDesigns* m_designs;
    std::map<std::string, ToldLoom> m_looms;
    std::map<std::string, std::pair<std::int64_t, std::string>> m_places;  ///< pick and person by place
    std::vector<KeptThing> m_things;
};

}  // namespace weave::loomlink
