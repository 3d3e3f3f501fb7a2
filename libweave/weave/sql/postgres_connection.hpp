#pragma once

#include <weave/sql/postgres.hpp>

#include <libpq-fe.h>
#include <map>

namespace weave::sql {

/// See open_postgres(). Alone its sources know libpq.
class PostgresConnection final : public Connection {
  public:
    PostgresConnection(PGconn* handle, std::string place, std::chrono::milliseconds patience);
    ~PostgresConnection() override;

    /// The settings of a store, for this connection.
    Status configure(Access access);
    /// Why the connection is not there, or was lost.
    [[nodiscard]] Error lost() const;

    [[nodiscard]] Engine engine() const override { return Engine::postgres; }
    Status script(const std::string& text) override;
    Status begin_read() override;
    Status begin_write() override;
    Status commit() override;
    [[nodiscard]] bool in_transaction() const override;
    [[nodiscard]] bool is_usable() const override;
    [[nodiscard]] std::int64_t changes() const override { return m_changes; }
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
    struct Freed {
        void operator()(PGresult* result) const { PQclear(result); }
    };
    using Answer = std::unique_ptr<PGresult, Freed>;
    using Deadline = std::optional<std::chrono::steady_clock::time_point>;

    /// The next answer of what was sent, none after the last. An error where the way is lost or the deadline passes.
    Result<Answer> next(const Deadline& deadline = {});
    /// Reads answers to the end; the first error of them counts. `take` gets each row.
    Status finish(const std::function<void(const Row&)>* take, const Deadline& deadline = {});
    Result<std::string> prepared(std::string_view text);
    Error trouble(const PGresult* answer);
    /// Who holds the lock that somebody waited for in vain.
    std::string why_locked();
    static void note_warning(void* connection, const PGresult* notice);

    PGconn* m_handle;
    std::string m_place, m_label;
    std::chrono::milliseconds m_patience;
    std::map<std::string, std::string, std::less<>> m_statements;  ///< names by texts
    std::int64_t m_changes = 0;
    std::string m_last_command;        ///< as the server calls what it did last
    std::string m_warning;             ///< the last; one at a commit is that it was not waited for
    bool m_is_late = false;            ///< an answer is still to come: nothing more can be asked
};

}  // namespace weave::sql
