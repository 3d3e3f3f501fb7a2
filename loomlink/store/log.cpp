#include <weave/sql/database.hpp>

#include <loomlink/store/reader.hpp>
#include <loomlink/store/writer.hpp>

namespace weave::loomlink {

namespace {

std::int64_t signed_of(std::uint64_t number) {
    return static_cast<std::int64_t>(number);
}

Error damaged(const std::string& what) {
    return system_fault("the store is damaged: " + what + "; restore a backup");
}

}  // namespace

Result<std::string> Reader::site() const {
    WEAVE_TRY(const auto name,
              connection().one("SELECT name FROM site", [](const sql::Row& row) { return row.bytes(0); }));
    if (!name) return damaged("it has no site");
    return *name;
}

Result<std::uint64_t> Reader::log_size() const {
    WEAVE_TRY(const std::int64_t size, connection().number("SELECT coalesce(max(seq) + 1, 0) FROM event"));
    return static_cast<std::uint64_t>(size);
}

Reader::List<std::pair<Seq, std::string>> Reader::events(const EventFilter& filter) const {
    const auto most = static_cast<std::int64_t>(std::min<std::size_t>(filter.most, INT32_MAX));
    const auto make = [](const sql::Row& row) {
        return std::pair(static_cast<Seq>(row.integer(0)), row.bytes(1));
    };
    const std::int64_t from = signed_of(filter.from);
    if (filter.subject)
        return connection().all(
            "SELECT seq, record FROM event WHERE subject = ?1 AND seq >= ?2 AND kind = coalesce(?3, kind) "
            "ORDER BY seq LIMIT ?4",
            make, *filter.subject, from, filter.kind, most);
    if (filter.kind)
        return connection().all(
            "SELECT seq, record FROM event WHERE kind = ? AND seq >= ? ORDER BY seq LIMIT ?", make,
            *filter.kind, from, most);
    return connection().all("SELECT seq, record FROM event WHERE seq >= ? ORDER BY seq LIMIT ?", make, from,
                            most);
}

Result<EventRecord> Reader::record(Seq seq) const {
    WEAVE_TRY(const auto found, events({.from = seq, .most = 1, .kind = {}, .subject = {}}));
    if (found.empty() || found.front().first != seq) return damaged("a record of the log is missing");
    return parse_record(found.front().second);
}

NodeReader Reader::nodes() const {
    return [database = m_connection](NodePlace place) -> Result<Hash> {
        const auto make = [](const sql::Row& row) { return row.fixed<Hash>(0); };
        const std::int64_t index = signed_of(place.index);
        WEAVE_TRY(const auto hash,
                  place.level == 0
                      ? database->one("SELECT leaf FROM event WHERE seq = ?", make, index)
                      : database->one("SELECT hash FROM tree_node WHERE level = ? AND position = ?", make,
                                      static_cast<std::int64_t>(place.level), index));
        if (!hash) return damaged("a node of the log's tree is missing");
        return *hash;
    };
}

Result<Hash> Reader::root(std::uint64_t size) const {
    WEAVE_TRY(const std::uint64_t all, log_size());
    if (size > all) return bad_input("the log has " + std::to_string(all) + " records");
    return tree_root(size, nodes());
}

Result<std::vector<Hash>> Reader::inclusion(Seq seq, std::uint64_t size) const {
    WEAVE_TRY(const std::uint64_t all, log_size());
    if (size > all) return bad_input("the log has " + std::to_string(all) + " records");
    return inclusion_proof(seq, size, nodes());
}

Result<std::vector<Hash>> Reader::consistency(std::uint64_t old_size, std::uint64_t size) const {
    WEAVE_TRY(const std::uint64_t all, log_size());
    if (size > all) return bad_input("the log has " + std::to_string(all) + " records");
    return consistency_proof(old_size, size, nodes());
}

Reader::Maybe<SignedTreeHead> Reader::latest_head() const {
    WEAVE_TRY(const auto bytes, connection().one("SELECT head FROM tree_head ORDER BY id DESC LIMIT 1",
                                                 [](const sql::Row& row) { return row.bytes(0); }));
    if (!bytes) return std::optional<SignedTreeHead>();
    WEAVE_TRY(SignedTreeHead head, parse_signed_head(*bytes));
    return std::optional(std::move(head));
}

Reader::Maybe<AuditBundle> Reader::bundle() const {
    WEAVE_TRY(auto head, latest_head());
    if (!head) return std::optional<AuditBundle>();
    AuditBundle bundle{*std::move(head), {}, {}};
    WEAVE_CHECK_OK(connection().each(
        "SELECT leaf, record FROM event WHERE seq < ? ORDER BY seq",
        [&](const sql::Row& row) {
            bundle.leaves.push_back(row.fixed<Hash>(0));
            bundle.records.push_back(row.bytes(1));
        },
        signed_of(bundle.head.head.size)));
    return std::optional(std::move(bundle));
}

Result<Seq> Writer::append(const Statement& statement, const std::optional<RecordSignature>& signature) {
    WEAVE_TRY(const std::string here, site());
    if (statement.site != here)
        return Error{ErrorCode::refused, "is a statement of another site", "statement.site"};
    WEAVE_TRY(const std::uint64_t size, log_size());
    EventRecord record{size, {}, statement, signature};
    if (size > 0) {
        WEAVE_TRY(record.prev, nodes()({0, size - 1}));
    }
    WEAVE_TRY(const std::string bytes, record_bytes(record));
    const Hash leaf = leaf_hash(bytes);
    WEAVE_CHECK_OK(connection().run(
        "INSERT INTO event (seq, record, leaf, kind, actor, subject) VALUES (?, ?, ?, ?, ?, ?)",
        signed_of(size), sql::Blob{bytes}, leaf, statement.kind, statement.actor, statement.subject));
    WEAVE_TRY(const auto complete, append_leaf(size, leaf, nodes()));
    for (const auto& [place, hash] : complete)
        if (place.level > 0)
            WEAVE_CHECK_OK(connection().run("INSERT INTO tree_node (level, position, hash) VALUES (?, ?, ?)",
                                            static_cast<std::int64_t>(place.level), signed_of(place.index),
                                            hash));
    return size;
}

Status Writer::add_head(const SignedTreeHead& head) {
    WEAVE_TRY(const std::string here, site());
    WEAVE_TRY(const std::uint64_t size, log_size());
    if (head.head.site != here || head.head.size == 0 || head.head.size > size)
        return Error{ErrorCode::refused, "is not a head of this log", {}};
    WEAVE_TRY(const Hash expected, root(head.head.size));
    if (head.head.root != expected) return Error{ErrorCode::refused, "has another root than this log", {}};
    const std::string bytes = signed_head_bytes(head);
    WEAVE_CHECK_OK(parse_signed_head(bytes));
    return connection().run("INSERT INTO tree_head (last_event, head) VALUES (?, ?)",
                            signed_of(head.head.size - 1), sql::Blob{bytes});
}

}  // namespace weave::loomlink
