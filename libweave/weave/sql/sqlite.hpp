#pragma once

#include <weave/sql/database.hpp>

#include <map>
#include <sqlite3.h>

namespace weave::sql {

/// A connection to a file of SQLite. Durable by WAL and synchronous=FULL: with NORMAL a power loss takes acknowledged
/// commits back.
class SqliteConnection final : public Connection {
  public:
    static Result<std::unique_ptr<SqliteConnection>> open_file(
        const std::string& path, Access access,
        std::chrono::milliseconds patience = std::chrono::seconds(10));
    ~SqliteConnection() override;

    [[nodiscard]] sqlite3* handle() const { return m_handle; }
    /// What the connection's last call failed of, in words for a person.
    [[nodiscard]] Error trouble(int code) const;

    [[nodiscard]] Engine engine() const override { return Engine::sqlite; }
    Status script(const std::string& text) override;
    Status begin_read() override { return script("BEGIN"); }
    Status begin_write() override { return script("BEGIN IMMEDIATE"); }
    Status commit() override { return script("COMMIT"); }
    [[nodiscard]] bool in_transaction() const override { return sqlite3_get_autocommit(m_handle) == 0; }
    [[nodiscard]] bool is_usable() const override { return true; }
    [[nodiscard]] std::int64_t changes() const override { return sqlite3_changes64(m_handle); }
    Status rows(std::string_view text, std::span<const Value> values,
                const std::function<void(const Row&)>& take) override;
    Result<Stamp> stamp() override;
    Status set_stamp(const Stamp& stamp) override;
    Result<bool> is_empty() override;
    Status clear() override;
    Status inspect_pages(const Find& find) override;
    Status inspect_links(const Find& find) override;
    Result<std::set<std::string>> rules() override;
    Result<std::unique_ptr<Connection>> scratch() override;
    Status load(const std::function<Status()>& fill) override;

  private:
    SqliteConnection(sqlite3* handle, std::string path) : m_handle(handle), m_path(std::move(path)) {}
    Status configure(Access access, std::chrono::milliseconds patience);
    Result<sqlite3_stmt*> prepared(std::string_view text);

    sqlite3* m_handle;
    std::string m_path;
    std::map<std::string, sqlite3_stmt*, std::less<>> m_statements;  // by their text
};

}  // namespace weave::sql
