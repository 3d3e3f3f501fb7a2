#pragma once

#include <weave/core/result.hpp>
#include <weave/sql/database.hpp>

#include <cstdint>
#include <loomlink/audit/tree.hpp>
#include <mutex>
#include <optional>
#include <utility>

namespace weave::loomlink {

/// The last record of the log that was acknowledged here, by which a server that was put in the place of another is known:
/// an old primary that came back, or a standby that lagged, does not hold it. Safe to use from any thread.
class LogMark {
  public:
    using Record = std::pair<std::int64_t, Hash>;  ///< number and leaf

    /// The last record as a connection sees it now.
    static Result<std::optional<Record>> newest(sql::Connection& connection);

    void set(const std::optional<Record>& record);
    /// Refused: a database that lacks the record, or holds another in its place.
    Status check(sql::Connection& connection) const;

  private:
    mutable std::mutex m_mutex;
    std::optional<Record> m_record;
};

}  // namespace weave::loomlink
