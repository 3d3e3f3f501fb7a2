#include <loomlink/store/log_mark.hpp>

namespace weave::loomlink {

Result<std::optional<LogMark::Record>> LogMark::newest(sql::Connection& connection) {
    return connection.one("SELECT seq, leaf FROM event ORDER BY seq DESC LIMIT 1",
                          [](const sql::Row& row) { return Record(row.integer(0), row.fixed<Hash>(1)); });
}

void LogMark::set(const std::optional<Record>& record) {
    const std::lock_guard lock(m_mutex);
    m_record = record;
}

Status LogMark::check(sql::Connection& connection) const {
    std::optional<Record> expected;
    {
        const std::lock_guard lock(m_mutex);
        expected = m_record;
    }
    if (!expected) return {};
    WEAVE_TRY(const auto leaf, connection.one(
                                   "SELECT leaf FROM event WHERE seq = ?", [](const sql::Row& row) { return row.fixed<Hash>(0); },
                                   expected->first));
    if (leaf == expected->second) return {};
    return system_fault("the server holds another log than before: record " + std::to_string(expected->first) +
                        (leaf ? " is another one" : " is missing") +
                        ". It is an old primary, or a standby that lagged; stop it, and see \"Two primaries\" in loomlink/RUNBOOK.md");
}

}  // namespace weave::loomlink
