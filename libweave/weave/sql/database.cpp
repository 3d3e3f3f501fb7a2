#include <weave/sql/database.hpp>

#include <cerrno>
#include <filesystem>
#include <unistd.h>

namespace weave::sql {

namespace {

std::string in_hex(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

}  // namespace

std::string_view Row::view(int column) const {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(m_statement, column));
    const int size = sqlite3_column_bytes(m_statement, column);
    return data == nullptr ? std::string_view() : std::string_view(data, static_cast<std::size_t>(size));
}

std::string Row::bytes(int column) const {
    return std::string(view(column));
}

Json Row::json(int column) const {
    switch (sqlite3_column_type(m_statement, column)) {
        case SQLITE_INTEGER:
            return integer(column);
        case SQLITE_FLOAT:
            return real(column);
        case SQLITE_TEXT:
            return bytes(column);
        case SQLITE_BLOB:
            return in_hex(view(column));
        default:
            return nullptr;
    }
}

namespace {

/// SQLite writes beside a database in use even to read it; its own message does not say so.
std::string why_not_opened(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return "";
    return ": its folder cannot be written, which even reading needs; copy it to another place first";
}

}  // namespace

Result<std::unique_ptr<Connection>> Connection::open(const std::string& path, Access access,
                                                     std::chrono::milliseconds patience) {
    const int flags =
        SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE | (access == Access::create ? SQLITE_OPEN_CREATE : 0);
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
    if (handle == nullptr) return system_fault("there is no memory to open the store", path);
    std::unique_ptr<Connection> connection(new Connection(handle, path));
    if (code != SQLITE_OK) return connection->trouble(code);
    WEAVE_CHECK_OK(connection->configure(access, patience));
    return connection;
}

Status Connection::configure(Access access, std::chrono::milliseconds patience) {
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

Connection::~Connection() {
    for (const auto& [text, statement] : m_statements) sqlite3_finalize(statement);
    sqlite3_close(m_handle);
}

Status Connection::script(const std::string& text) {
    const int code = sqlite3_exec(m_handle, text.c_str(), nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) return trouble(code);
    return {};
}

Result<sqlite3_stmt*> Connection::prepared(const char* text) {
    const auto known = m_statements.find(text);
    if (known != m_statements.end()) return known->second;
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v3(m_handle, text, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
    if (code != SQLITE_OK) return trouble(code);
    m_statements.emplace(text, statement);
    return statement;
}

Error Connection::trouble(int code) const {
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
