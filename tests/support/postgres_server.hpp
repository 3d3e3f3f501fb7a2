#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>

namespace weave::testing {

/// A server of PostgreSQL for tests: a fresh cluster in a folder of its own, reached by a Unix socket in that folder alone, run by
/// an unprivileged user (`postgres` where the test is root). It writes without flushing, unless `flushed`: what it is killed for
/// here is the process, never the power.
class PostgresServer {
  public:
    /// Whether the machine has one. Where not, tests of it are to say so and do nothing.
    static bool is_installed();
    /// The one that lives as long as the tests do, for whatever needs a database and no fault.
    static PostgresServer& shared();

    /// An empty primary that runs.
    PostgresServer();
    /// A standby of a primary that runs: it follows by streaming, under `name`.
    PostgresServer(const PostgresServer& primary, const std::string& name);
    ~PostgresServer();
    PostgresServer(const PostgresServer&) = delete;
    PostgresServer& operator=(const PostgresServer&) = delete;

    /// The connection string of a database, and of one that is found on any of two servers.
    [[nodiscard]] std::string place(const std::string& database = "postgres", const std::string& user = "postgres") const;
    [[nodiscard]] std::string place_with(const PostgresServer& other, const std::string& database) const;
    [[nodiscard]] const std::filesystem::path& folder() const { return m_folder; }

    /// A new, empty database. Its name is the answer.
    std::string make_database();
    std::string copy_database(const std::string& from);
    void drop_database(const std::string& name);
    /// Runs a script as the administrator.
    void run(const std::string& script, const std::string& database = "postgres") const;
    /// The number that a question answers.
    [[nodiscard]] std::int64_t number(const std::string& question, const std::string& database = "postgres") const;

    /// Starts it again after an end, and answers once it takes connections.
    void start();
    /// kill -9 of all of it.
    void kill();
    void stop();
    /// Its disk is full whenever this file is there (tests/support/full_disk.cpp).
    [[nodiscard]] std::filesystem::path full_disk() const { return m_folder / "full"; }
    /// Puts its write-ahead log on a small disk of its own, and starts it again. Its folder; empty where this process may mount nothing.
    std::filesystem::path move_log_to_small_disk();
    /// Stops what a standby receives, as a line that is cut would: it lags from then on.
    void cut_off() const;
    /// Makes a standby a primary, and answers once it is.
    void promote();
    /// Adds lines to its configuration; they count from the next start, or with reload().
    void configure(const std::string& lines) const;
    void reload() const;

  private:
    void make_folder();
    void write_settings() const;
    void wait_until(const std::string& question) const;

    std::filesystem::path m_folder, m_log_disk;
    pid_t m_process = 0;
    int m_databases = 0;
};

}  // namespace weave::testing
