#pragma once

// Where the stores of tests lie. Tests of what stands in them run on both databases alike: on files of SQLite, and, where the
// environment says WEAVE_TEST_STORE=postgresql, on databases of a server that the tests start. What is about files alone is
// tagged [file].

#include <weave/sql/database.hpp>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <sqlite3.h>
#include <stdexcept>
#include <string>
#include <support/postgres_server.hpp>
#include <unistd.h>

namespace weave::loomlink::testing {

using weave::testing::PostgresServer;

inline bool stores_are_on_server() {
    const char* const wish = std::getenv("WEAVE_TEST_STORE");
    return wish != nullptr && std::string(wish) == "postgresql";
}

inline std::string database_of(const std::string& place) {
    const std::size_t from = std::string("postgresql:///").size();
    return place.substr(from, place.find('?') - from);
}

/// A folder of its own, removed at the end.
class Folder {
  public:
    Folder() {
        static std::atomic<int> count = 0;
        m_path = std::filesystem::temp_directory_path() /
                 ("weave-store-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
        std::filesystem::remove_all(m_path);
        std::filesystem::create_directories(m_path);
    }
    ~Folder() {
        for (const auto& [name, database] : m_databases) PostgresServer::shared().drop_database(database);
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return m_path / name; }

    /// The place of a store of that name: a file in the folder, or on a server a database of its own.
    [[nodiscard]] std::string store(const std::string& name) const {
        return stores_are_on_server() ? place_of(name, [] { return PostgresServer::shared().make_database(); })
                                      : (m_path / name).string();
    }
    /// The place of a store that is the copy of another, byte by byte, rules or no rules; nobody may have that open.
    [[nodiscard]] std::string copy(const std::string& from, const std::string& name) const {
        if (!stores_are_on_server()) {
            for (const char* more : {"-wal", "-shm"}) std::filesystem::remove((m_path / name).string() + more);
            std::filesystem::copy_file(from, m_path / name, std::filesystem::copy_options::overwrite_existing);
            return m_path / name;
        }
        if (m_databases.contains(name)) PostgresServer::shared().drop_database(m_databases[name]);
        m_databases.erase(name);
        return place_of(name, [&] { return PostgresServer::shared().copy_database(database_of(from)); });
    }

  private:
    template <class Make>
    std::string place_of(const std::string& name, const Make& make) const {
        if (!m_databases.contains(name)) m_databases[name] = make();
        return PostgresServer::shared().place(m_databases[name]);
    }
    mutable std::map<std::string, std::string> m_databases;  ///< by the names of stores
    std::filesystem::path m_path;
};


/// flip(blob, number): the blob with one bit turned, whichever the number comes to.
inline void flip_bit(sqlite3_context* context, int, sqlite3_value** values) {
    const auto* data = static_cast<const char*>(sqlite3_value_blob(values[0]));
    std::string bytes(data, static_cast<std::size_t>(sqlite3_value_bytes(values[0])));
    const auto bit = static_cast<std::size_t>(sqlite3_value_int64(values[1])) % (8 * bytes.size());
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    sqlite3_result_blob(context, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
}

/// Runs SQL on a store's file behind its back.
inline void tamper_with_file(const std::string& path, const std::string& sql) {
    sqlite3* handle = nullptr;
    if (sqlite3_open(path.c_str(), &handle) != SQLITE_OK) throw std::runtime_error("cannot open");
    sqlite3_create_function(handle, "flip", 2, SQLITE_UTF8, nullptr, flip_bit, nullptr, nullptr);
    char* message = nullptr;
    const int code = sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, &message);
    const std::string text = message == nullptr ? "" : message;
    sqlite3_free(message);
    sqlite3_close(handle);
    if (code != SQLITE_OK) throw std::runtime_error(text);
}

/// The words of SQLite's in tests, as a server understands them.
std::string for_server(const std::string& sql);

/// The same with all rules asleep, and awake again as if nothing had been.
inline void tamper_without_rules(const std::string& place, const std::string& sql) {
    if (sql::engine_of(place) == sql::Engine::postgres) {
        const auto each_table = [](const std::string& what) {
            return "DO $$ DECLARE t regclass; BEGIN FOR t IN SELECT g.tgrelid FROM pg_trigger g WHERE g.tgname = 'numbers_itself' LOOP "
                   "EXECUTE format('ALTER TABLE %s ENABLE " +
                   what + " TRIGGER numbers_itself', t); END LOOP; END $$;";
        };
        return PostgresServer::shared().run(each_table("ALWAYS") + "SET session_replication_role = replica;" + for_server(sql) +
                                                ";SET session_replication_role = origin;" + each_table(""),
                                            database_of(place));
    }
    const auto connection = sql::Connection::open(place, sql::Access::write).value();
    static_cast<void>(connection->script("PRAGMA foreign_keys = OFF"));
    const Status done = connection->load([&] { return connection->script(sql); });
    if (!done) throw std::runtime_error(done.error().text());
}

/// Runs SQL on a store behind its back.
inline void tamper_with(const std::string& place, const std::string& sql) {
    if (sql::engine_of(place) == sql::Engine::sqlite) return tamper_with_file(place, sql);
    if (sql.find("DROP TRIGGER") == 0 && sql.find(';') != std::string::npos) return tamper_without_rules(place, sql);
    PostgresServer::shared().run(for_server(sql), database_of(place));
}

}  // namespace weave::loomlink::testing
