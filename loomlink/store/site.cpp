#include <weave/sql/database.hpp>

#include <loomlink/store/reader.hpp>
#include <loomlink/store/writer.hpp>

namespace weave::loomlink {

namespace {

Invitation invitation_of(const sql::Row& row) {
    Invitation invitation{
        row.fixed<Hash>(0), row.bytes(1), {}, row.bytes(3),
        row.bytes(4),       static_cast<Seq>(row.integer(5)),
        {}};
    if (!row.is_null(2)) invitation.name = row.bytes(2);
    if (!row.is_null(6)) invitation.used = static_cast<Seq>(row.integer(6));
    return invitation;
}

std::int64_t number_of(Seq seq) {
    return static_cast<std::int64_t>(seq);
}

/// A trust document's row, and the hash of its object.
using TrustRow = std::pair<SitePaper, Hash>;

TrustRow trust_row(const sql::Row& row) {
    return {{row.integer(0), {}, static_cast<Seq>(row.integer(2))}, row.fixed<Hash>(1)};
}

Result<SitePaper> with_text(const Reader& reader, TrustRow row) {
    WEAVE_TRY(auto text, reader.object(row.second));
    if (!text) return system_fault("the store is damaged: a trust document is missing");
    row.first.text = *std::move(text);
    return std::move(row.first);
}

}  // namespace

Reader::Maybe<Invitation> Reader::invitation(const Hash& code) const {
    return connection().one(
        "SELECT code, purpose, name, roles, expires, event, used FROM invitation WHERE code = ?",
        invitation_of, code);
}

Reader::Maybe<SitePaper> Reader::policy() const {
    return connection().one(
        "SELECT version, text, event FROM policy ORDER BY version DESC LIMIT 1", [](const sql::Row& row) {
            return SitePaper{row.integer(0), row.bytes(1), static_cast<Seq>(row.integer(2))};
        });
}

Reader::List<SitePaper> Reader::trust_documents(std::int64_t from) const {
    WEAVE_TRY(const auto rows, connection().all("SELECT t.number, o.hash, t.event FROM trust_document t "
                                                "JOIN object o ON o.id = t.object "
                                                "WHERE t.number >= ? ORDER BY t.number",
                                                trust_row, from));
    std::vector<SitePaper> papers;
    for (const TrustRow& row : rows) {
        WEAVE_TRY(SitePaper paper, with_text(*this, row));
        papers.push_back(std::move(paper));
    }
    return papers;
}

Reader::Maybe<SitePaper> Reader::latest_trust() const {
    WEAVE_TRY(const auto row, connection().one("SELECT t.number, o.hash, t.event FROM trust_document t JOIN "
                                               "object o ON o.id = t.object ORDER BY t.number DESC LIMIT 1",
                                               trust_row));
    if (!row) return std::optional<SitePaper>();
    WEAVE_TRY(SitePaper paper, with_text(*this, *row));
    return std::optional(std::move(paper));
}

Status Writer::add_invitation(const Invitation& invitation) {
    return connection().run(
        "INSERT INTO invitation (code, purpose, name, roles, expires, event) VALUES (?, ?, ?, ?, ?, ?)",
        invitation.code, invitation.purpose, invitation.name, invitation.roles, invitation.expires,
        number_of(invitation.event));
}

Status Writer::use_invitation(const Hash& code, Seq event) {
    WEAVE_CHECK_OK(connection().run("UPDATE invitation SET used = ? WHERE code = ?", number_of(event), code));
    if (connection().changes() == 1) return {};
    return Error{ErrorCode::refused, "there is no such invitation", {}};
}

Status Writer::add_policy(const std::string& text, Seq event) {
    WEAVE_TRY(const std::int64_t last, connection().number("SELECT coalesce(max(version), 0) FROM policy"));
    return connection().run("INSERT INTO policy (version, text, event) VALUES (?, ?, ?)", last + 1, text,
                            number_of(event));
}

Status Writer::add_trust(std::int64_t number, const Hash& object, Seq event) {
    WEAVE_TRY(const Id id, object_id(object));
    return connection().run("INSERT INTO trust_document (number, object, event) VALUES (?, ?, ?)", number, id,
                            number_of(event));
}

}  // namespace weave::loomlink
