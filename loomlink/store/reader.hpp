#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/tree.hpp>
#include <loomlink/store/records.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace weave::sql {
class Connection;
}

namespace weave::loomlink {

/// Which records of the log are asked for.
struct EventFilter {
    Seq from = 0;
    std::size_t most = 100;
    std::optional<std::string> kind;
    std::optional<std::string> subject;
};

/// Questions to the store, all on one unchanging view. An error is one of the system; what is not there is an
/// empty answer.
class Reader {
  public:
    template <class T>
    using List = Result<std::vector<T>>;
    template <class T>
    using Maybe = Result<std::optional<T>>;

    [[nodiscard]] Result<std::string> site() const;

    // The log
    [[nodiscard]] Result<std::uint64_t> log_size() const;
    /// The canonical bytes of records, oldest first, with their numbers.
    [[nodiscard]] List<std::pair<Seq, std::string>> events(const EventFilter& filter) const;
    /// One record, read.
    [[nodiscard]] Result<EventRecord> record(Seq seq) const;
    /// The root of the first `size` records.
    [[nodiscard]] Result<Hash> root(std::uint64_t size) const;
    [[nodiscard]] Result<std::vector<Hash>> inclusion(Seq seq, std::uint64_t size) const;
    [[nodiscard]] Result<std::vector<Hash>> consistency(std::uint64_t old_size, std::uint64_t size) const;
    [[nodiscard]] Maybe<SignedTreeHead> latest_head() const;
    /// The log up to the latest head; nothing where no head was signed yet.
    [[nodiscard]] Maybe<AuditBundle> bundle() const;

    // Objects
    [[nodiscard]] Result<bool> has_object(const Hash& hash) const;
    /// The bytes, held to their hash: a damaged object is an error, never given out.
    [[nodiscard]] Maybe<std::string> object(const Hash& hash) const;

    // People
    [[nodiscard]] List<Person> people() const;
    [[nodiscard]] Maybe<Person> person(Id id) const;
    [[nodiscard]] Maybe<Person> person(const std::string& login) const;
    [[nodiscard]] Maybe<PersonKey> key(const std::string& id) const;
    [[nodiscard]] List<PersonKey> keys(std::optional<Id> person) const;
    /// The session of a token's hash, unless it has expired by `now`.
    [[nodiscard]] Maybe<Session> session(const Hash& token, const std::string& now) const;
    /// The answer recorded for a request of this person. Refused: the same id used by another person.
    [[nodiscard]] Maybe<std::string> answer(const std::string& request, Id person) const;

    // The site
    [[nodiscard]] Maybe<Invitation> invitation(const Hash& code) const;
    /// The newest policy.
    [[nodiscard]] Maybe<SitePaper> policy() const;
    /// Trust documents from this number on, as signed, oldest first.
    [[nodiscard]] List<SitePaper> trust_documents(std::int64_t from) const;
    [[nodiscard]] Maybe<SitePaper> latest_trust() const;

    // Designs
    [[nodiscard]] List<Design> designs() const;
    [[nodiscard]] Maybe<Design> design(const std::string& name) const;
    [[nodiscard]] List<Branch> branches(Id design) const;
    /// All of a design, oldest first, with parents, authors and state.
    [[nodiscard]] List<Revision> revisions(Id design) const;
    [[nodiscard]] Maybe<Revision> revision(Id id) const;
    [[nodiscard]] Maybe<Revision> revision(Id design, std::int64_t number) const;
    [[nodiscard]] List<Revision> revisions_in(RevisionState state) const;
    [[nodiscard]] List<Step<RevisionState>> revision_steps(Id revision) const;
    [[nodiscard]] List<Decision> decisions(Id revision) const;
    [[nodiscard]] List<Waiver> waivers(Id revision) const;
    [[nodiscard]] List<Evidence> evidence(const Hash& design_sha256, const Hash& scene_sha256) const;
    [[nodiscard]] List<Comment> comments(Id revision) const;

    // Looms and releases
    [[nodiscard]] List<Loom> looms() const;
    [[nodiscard]] Maybe<Loom> loom(const std::string& name) const;
    [[nodiscard]] List<LoomProfileVersion> profiles(Id loom) const;
    [[nodiscard]] List<Loom> looms_of(Id operator_person) const;
    [[nodiscard]] List<Person> operators(Id loom) const;
    [[nodiscard]] Maybe<Release> release(Id id) const;
    /// All of a loom, newest first, with files, signatures and state.
    [[nodiscard]] List<Release> releases(Id loom) const;
    [[nodiscard]] List<Release> releases_of(Id revision) const;
    [[nodiscard]] List<Step<ReleaseStage>> release_steps(Id release) const;
    [[nodiscard]] Maybe<Bookmark> bookmark(Id release) const;
    [[nodiscard]] List<FaultReport> faults(Id release) const;
    [[nodiscard]] List<Loaded> loaded(Id release) const;

    /// All that the tables keep beside log and objects, sorted; roles by their words. Not in it:
    /// answers to requests, which are of today, and what hashes and constraints hold (objects, parents of
    /// revisions). Of passwords' hashes and sealed keys only the SHA-256 is told.
    [[nodiscard]] List<KeptThing> kept() const;

    explicit Reader(sql::Connection& connection) : m_connection(&connection) {}

  protected:
    [[nodiscard]] sql::Connection& connection() const { return *m_connection; }
    /// The complete subtrees of the log.
    [[nodiscard]] NodeReader nodes() const;

  private:
    sql::Connection* m_connection;
};

}  // namespace weave::loomlink
