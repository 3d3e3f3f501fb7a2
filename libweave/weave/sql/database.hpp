#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/hash.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <sqlite3.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weave::sql {

/// Bytes to be bound as a BLOB, as an array of bytes is; a plain string is bound as TEXT.
struct Blob {
    std::string_view bytes;
};

/// What the row that a statement stands on holds, column by column from 0.
class Row {
  public:
    explicit Row(sqlite3_stmt* statement) : m_statement(statement) {}
    [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(m_statement, column); }
    [[nodiscard]] double real(int column) const { return sqlite3_column_double(m_statement, column); }
    [[nodiscard]] bool is_null(int column) const {
        return sqlite3_column_type(m_statement, column) == SQLITE_NULL;
    }
    [[nodiscard]] int columns() const { return sqlite3_column_count(m_statement); }
    /// A number, text, or null; of a BLOB its bytes in hexadecimal.
    [[nodiscard]] Json json(int column) const;
    /// TEXT or BLOB as it is.
    [[nodiscard]] std::string bytes(int column) const;
    /// A BLOB of a fixed size, such as a hash: `fixed<std::array<unsigned char, 32>>(0)`; zeros where the
    /// column holds anything else.
    template <class Array>
    [[nodiscard]] Array fixed(int column) const {
        Array value{};
        const std::string_view found = view(column);
        if (found.size() == value.size()) std::copy(found.begin(), found.end(), value.begin());
        return value;
    }

  private:
    [[nodiscard]] std::string_view view(int column) const;

    sqlite3_stmt* m_statement;
};

enum class Access : std::uint8_t { create, write, read };

/// One connection with the settings of a store, and its prepared statements. For one thread at a time.
class Connection {
  public:
    /// Opens a database; `create` makes it where it is missing, `write` and `read` refuse what is missing. A
    /// database is durable by WAL and synchronous=FULL: with NORMAL a power loss takes acknowledged commits
    /// back. Each statement waits `patience` for other connections that are in its way.
    static Result<std::unique_ptr<Connection>> open(
        const std::string& path, Access access,
        std::chrono::milliseconds patience = std::chrono::seconds(10));
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Runs a script of fixed text, such as a migration. No value ever goes into its text.
    Status script(const std::string& text);

    /// Runs a statement without an answer.
    template <class... Values>
    Status run(const char* text, const Values&... values) {
        return each(
            text, [](const Row&) {}, values...);
    }
    /// Runs an INSERT and tells the number of the new row.
    template <class... Values>
    Result<std::int64_t> insert(const char* text, const Values&... values) {
        WEAVE_CHECK_OK(run(text, values...));
        return sqlite3_last_insert_rowid(m_handle);
    }
    /// Calls `take(row)` for each row. It must not run the same statement.
    template <class Take, class... Values>
    Status each(const char* text, Take take, const Values&... values) {
        WEAVE_TRY(sqlite3_stmt* const statement, prepared(text));
        const Reset reset{statement};
        int column = 0;
        for (const int code : {SQLITE_OK, bind(statement, ++column, values)...})
            if (code != SQLITE_OK) return trouble(code);
        int code = SQLITE_ROW;
        while ((code = sqlite3_step(statement)) == SQLITE_ROW) take(Row(statement));
        if (code != SQLITE_DONE) return trouble(code);
        return {};
    }
    /// All rows as `make(row)` makes them.
    template <class Make, class... Values>
    auto all(const char* text, Make make, const Values&... values)
        -> Result<std::vector<decltype(make(std::declval<Row>()))>> {
        std::vector<decltype(make(std::declval<Row>()))> rows;
        WEAVE_CHECK_OK(each(
            text, [&](const Row& row) { rows.push_back(make(row)); }, values...));
        return rows;
    }
    /// The first row, or nothing.
    template <class Make, class... Values>
    auto one(const char* text, Make make, const Values&... values)
        -> Result<std::optional<decltype(make(std::declval<Row>()))>> {
        std::optional<decltype(make(std::declval<Row>()))> found;
        WEAVE_CHECK_OK(each(
            text,
            [&](const Row& row) {
                if (!found) found = make(row);
            },
            values...));
        return found;
    }
    /// The number in the first column of the first row; 0 without a row.
    template <class... Values>
    Result<std::int64_t> number(const char* text, const Values&... values) {
        WEAVE_TRY(const auto found, one(
                                        text, [](const Row& row) { return row.integer(0); }, values...));
        return found.value_or(0);
    }

    /// Whether a transaction is open; a full disk may have ended one.
    [[nodiscard]] bool in_transaction() const { return sqlite3_get_autocommit(m_handle) == 0; }
    /// Rows that the last statement changed.
    [[nodiscard]] int changes() const { return sqlite3_changes(m_handle); }
    [[nodiscard]] sqlite3* handle() const { return m_handle; }
    /// What the connection's last call failed of, in words for a person.
    [[nodiscard]] Error trouble(int code) const;

  private:
    struct Reset {
        sqlite3_stmt* statement;
        ~Reset() {
            sqlite3_reset(statement);
            sqlite3_clear_bindings(statement);
        }
    };
    Connection(sqlite3* handle, std::string path) : m_handle(handle), m_path(std::move(path)) {}
    Status configure(Access access, std::chrono::milliseconds patience);
    Result<sqlite3_stmt*> prepared(const char* text);

    static int bind(sqlite3_stmt* statement, int column, std::int64_t value) {
        return sqlite3_bind_int64(statement, column, value);
    }
    static int bind(sqlite3_stmt* statement, int column, double value) {
        return sqlite3_bind_double(statement, column, value);
    }
    static int bind(sqlite3_stmt* statement, int column, const std::string& value) {
        return sqlite3_bind_text64(statement, column, value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8);
    }
    static int bind(sqlite3_stmt* statement, int column, Blob value) {
        return sqlite3_bind_blob64(statement, column, value.bytes.empty() ? "" : value.bytes.data(),
                                   value.bytes.size(), SQLITE_STATIC);
    }
    template <std::size_t Size>
    static int bind(sqlite3_stmt* statement, int column, const std::array<unsigned char, Size>& value) {
        return sqlite3_bind_blob64(statement, column, value.data(), value.size(), SQLITE_STATIC);
    }
    template <class Value>
    static int bind(sqlite3_stmt* statement, int column, const std::optional<Value>& value) {
        return value ? bind(statement, column, *value) : sqlite3_bind_null(statement, column);
    }

    sqlite3* m_handle;
    std::string m_path;
    std::map<const char*, sqlite3_stmt*> m_statements;  // by the address of their text, which is a literal
};

}  // namespace weave::sql
