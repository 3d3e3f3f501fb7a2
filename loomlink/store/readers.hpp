#pragma once

#include <weave/sql/database.hpp>

#include <condition_variable>
#include <loomlink/store/log_mark.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace weave::loomlink {

/// The connections that read a store: at most eight, opened as they are needed. Any thread may ask.
class Readers {
  public:
    /// A connection for as long as it lives; what it read is over then.
    class Lease {
      public:
        Lease(Readers& readers, std::unique_ptr<sql::Connection> connection)
            : m_readers(&readers), m_connection(std::move(connection)) {}
        ~Lease();
        Lease(Lease&&) noexcept = default;
        Lease& operator=(Lease&&) = delete;
        [[nodiscard]] sql::Connection& connection() const { return *m_connection; }

      private:
        Readers* m_readers;
        std::unique_ptr<sql::Connection> m_connection;
    };

    Readers(std::string place, sql::Access access) : m_place(std::move(place)), m_access(access) {}

    /// A connection that answers: one that is free, a new one, or the next that becomes free. Those whose server went
    /// away meanwhile are forgotten. A new one is held to the mark.
    Result<Lease> take(const LogMark& mark);

  private:
    Result<std::unique_ptr<sql::Connection>> open(const LogMark& mark);
    std::unique_ptr<sql::Connection> wait_for_one();
    void give_back(std::unique_ptr<sql::Connection> connection);

    std::string m_place;
    sql::Access m_access;
    std::mutex m_mutex;
    std::condition_variable m_free;
    std::vector<std::unique_ptr<sql::Connection>> m_idle;
    std::size_t m_open = 0;
};

}  // namespace weave::loomlink
