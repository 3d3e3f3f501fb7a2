#include <weave/sql/sqlite.hpp>

#include <cerrno>
#include <filesystem>
#include <unistd.h>

namespace weave::sql {

namespace {

class SqliteRow final : public Row {
  public:
    explicit SqliteRow(sqlite3_stmt* statement) : m_statement(statement) {}
    [[nodiscard]] int columns() const override { return sqlite3_column_count(m_statement); }
    [[nodiscard]] Value value(int column) const override {
        switch (sqlite3_column_type(m_statement, column)) {
            case SQLITE_INTEGER:
                return sqlite3_column_int64(m_statement, column);
            case SQLITE_FLOAT:
                return sqlite3_column_double(m_statement, column);
            case SQLITE_TEXT:
                return view(column);
            case SQLITE_BLOB:
                return Blob{view(column)};
            default:
                return {};
        }
    }

  private:
    [[nodiscard]] std::string_view view(int column) const {
        const auto* data = static_cast<const char*>(sqlite3_column_blob(m_statement, column));
        const int size = sqlite3_column_bytes(m_statement, column);
        return data == nullptr ? std::string_view() : std::string_view(data, static_cast<std::size_t>(size));
    }
    sqlite3_stmt* m_statement;
};

/// Ends a run of a statement that is kept.
struct Reset {
    sqlite3_stmt* statement;
    ~Reset() {
        sqlite3_reset(statement);
        sqlite3_clear_bindings(statement);
    }
};

struct Binder {
    sqlite3_stmt* statement;
    int column;
    int operator()(std::monostate) const { return sqlite3_bind_null(statement, column); }
    int operator()(std::int64_t value) const { return sqlite3_bind_int64(statement, column, value); }
    int operator()(double value) const { return sqlite3_bind_double(statement, column, value); }
    int operator()(std::string_view value) const {
        return sqlite3_bind_text64(statement, column, value.empty() ? "" : value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8);
    }
    int operator()(Blob value) const {
        return sqlite3_bind_blob64(statement, column, value.bytes.empty() ? "" : value.bytes.data(), value.bytes.size(),
                                   SQLITE_STATIC);
    }
};

/// SQLite writes beside a database in use even to read it; its own message does not say so.
std::string why_not_opened(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return "";
    return ": its folder cannot be written, which even reading needs; copy it to another place first";
}

}  // namespace

Result<std::unique_ptr<SqliteConnection>> SqliteConnection::open_file(const std::string& path, Access access,
                                                                      std::chrono::milliseconds patience) {
    if (access == Access::standby) return bad_input("a file has no standby that follows it", path);
    const int flags =
        SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE | (access == Access::create ? SQLITE_OPEN_CREATE : 0);
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
    if (handle == nullptr) return system_fault("there is no memory to open the store", path);
    std::unique_ptr<SqliteConnection> connection(new SqliteConnection(handle, path));
    if (code != SQLITE_OK) return connection->trouble(code);
    WEAVE_CHECK_OK(connection->configure(access, patience));
    return connection;
}

Status SqliteConnection::configure(Access access, std::chrono::milliseconds patience) {
    sqlite3_extended_result_codes(m_handle, 1);
    sqlite3_busy_timeout(m_handle, static_cast<int>(patience.count()));
    sqlite3_db_config(m_handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(m_handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(m_handle, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
    sqlite3_db_config(m_handle, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
    WEAVE_CHECK_OK(
        script("PRAGMA foreign_keys = ON; PRAGMA recursive_triggers = ON; PRAGMA synchronous = FULL;"
               "PRAGMA cell_size_check = ON; PRAGMA temp_store = MEMORY"));
    if (access == Access::create) WEAVE_CHECK_OK(script("PRAGMA journal_mode = WAL"));
    if (access == Access::read) WEAVE_CHECK_OK(script("PRAGMA query_only = ON"));
    return {};
}

SqliteConnection::~SqliteConnection() {
    for (const auto& [text, statement] : m_statements) sqlite3_finalize(statement);
    sqlite3_close(m_handle);
}

Status SqliteConnection::script(const std::string& text) {
    const int code = sqlite3_exec(m_handle, text.c_str(), nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) return trouble(code);
    return {};
}

Result<sqlite3_stmt*> SqliteConnection::prepared(std::string_view text) {
    const auto known = m_statements.find(text);
    if (known != m_statements.end()) return known->second;
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v3(m_handle, text.data(), static_cast<int>(text.size()), SQLITE_PREPARE_PERSISTENT,
                                        &statement, nullptr);
    if (code != SQLITE_OK) return trouble(code);
    m_statements.emplace(text, statement);
    return statement;
}

Status SqliteConnection::rows(std::string_view text, std::span<const Value> values,
                              const std::function<void(const Row&)>& take) {
    WEAVE_TRY(sqlite3_stmt* const statement, prepared(text));
    const Reset reset{statement};
    int column = 0;
    for (const Value& value : values)
        if (const int code = std::visit(Binder{statement, ++column}, value); code != SQLITE_OK) return trouble(code);
    int code = SQLITE_ROW;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW) take(SqliteRow(statement));
    if (code != SQLITE_DONE) return trouble(code);
    return {};
}

Result<Stamp> SqliteConnection::stamp() {
    Stamp stamp;
    WEAVE_TRY(stamp.application, number("PRAGMA application_id"));
    WEAVE_TRY(stamp.version, number("PRAGMA user_version"));
    return stamp;
}

Status SqliteConnection::set_stamp(const Stamp& stamp) {
    return script("PRAGMA application_id = " + std::to_string(stamp.application) +
                  "; PRAGMA user_version = " + std::to_string(stamp.version));
}

Result<bool> SqliteConnection::is_empty() {
    WEAVE_TRY(const std::int64_t tables, number("SELECT count(*) FROM sqlite_schema"));
    return tables == 0;
}

Status SqliteConnection::clear() {
    WEAVE_TRY(const auto tables, all("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'",
                                     [](const Row& row) { return row.bytes(0); }));
    WEAVE_CHECK_OK(script("PRAGMA defer_foreign_keys = ON"));
    for (const std::string& table : tables) WEAVE_CHECK_OK(script("DROP TABLE \"" + table + "\""));
    return {};
}

Status SqliteConnection::inspect_pages(const Find& find) {
    return each("PRAGMA integrity_check", [&](const Row& row) {
        if (row.bytes(0) != "ok") find("pages", row.bytes(0));
    });
}

Status SqliteConnection::inspect_links(const Find& find) {
    return each("PRAGMA foreign_key_check", [&](const Row& row) {
        find(row.bytes(0) + " " + std::to_string(row.integer(1)),
             "points at a row of " + row.bytes(2) + " that is not there");
    });
}

Result<std::set<std::string>> SqliteConnection::rules() {
    std::set<std::string> rules;
    WEAVE_CHECK_OK(each("SELECT type || ' ' || name || ': ' || sql FROM sqlite_schema WHERE sql IS NOT NULL "
                        "AND name NOT LIKE 'sqlite_%'",
                        [&](const Row& row) { rules.insert(row.bytes(0)); }));
    return rules;
}

Result<std::unique_ptr<Connection>> SqliteConnection::scratch() {
    WEAVE_TRY(std::unique_ptr<Connection> fresh, open_file(":memory:", Access::create));
    WEAVE_CHECK_OK(fresh->begin_write());
    return fresh;
}

Status SqliteConnection::load(const std::function<Status()>& fill) {
    WEAVE_TRY(const auto triggers, all("SELECT name, sql FROM sqlite_schema WHERE type = 'trigger'", [](const Row& row) {
                  return std::pair(row.bytes(0), row.bytes(1));
              }));
    for (const auto& [name, text] : triggers) WEAVE_CHECK_OK(script("DROP TRIGGER \"" + name + "\""));
    WEAVE_CHECK_OK(fill());
    for (const auto& [name, text] : triggers) WEAVE_CHECK_OK(script(text));
    return {};
}

Error SqliteConnection::trouble(int code) const {
    const std::string message = sqlite3_errmsg(m_handle);
    const int extended = sqlite3_extended_errcode(m_handle);
    switch (code & 0xff) {
        case SQLITE_CONSTRAINT:
            if (extended == SQLITE_CONSTRAINT_TRIGGER) return {ErrorCode::refused, message, {}};
            if (extended == SQLITE_CONSTRAINT_UNIQUE || extended == SQLITE_CONSTRAINT_PRIMARYKEY)
                return {ErrorCode::refused, "exists already (" + message + ")", {}};
            return {ErrorCode::refused, "the store does not take it (" + message + ")", {}};
        case SQLITE_FULL:
            return system_fault("the disk is full; nothing was stored", m_path);
        case SQLITE_IOERR:
            if (const int cause = sqlite3_system_errno(m_handle); cause == ENOSPC || cause == EDQUOT)
                return system_fault("the disk is full; nothing was stored", m_path);
            return system_fault(
                "the disk reports an error (" + std::to_string(extended) + "); nothing was stored", m_path);
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return system_fault("is in use by another program", m_path);
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            return system_fault("is damaged, or is no store (" + message + ")", m_path);
        case SQLITE_CANTOPEN:
            return system_fault("cannot be opened (" + message + ")" + why_not_opened(m_path), m_path);
        case SQLITE_READONLY:
            return system_fault("may not be written", m_path);
        case SQLITE_TOOBIG:
            return bad_input("is too large for the store");
        default:
            return system_fault("the store failed: " + message, m_path);
    }
}

}  // namespace weave::sql
