#include <loomlink/store/readers.hpp>

#include <utility>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_readers = 8;

/// A server may have gone since a connection was used last; a file does not go.
bool answers(sql::Connection& connection) {
    return connection.engine() == sql::Engine::sqlite || connection.run("SELECT 1") || connection.is_usable();
}

}  // namespace

Readers::Lease::~Lease() {
    if (!m_connection) return;
    m_connection->rollback();
    if (!m_connection->is_usable()) m_connection.reset();
    m_readers->give_back(std::move(m_connection));
}

Result<Readers::Lease> Readers::take(const LogMark& mark) {
    while (auto connection = wait_for_one()) {
        if (answers(*connection)) return Lease(*this, std::move(connection));
        give_back(nullptr);
    }
    auto connection = open(mark);
    if (connection) return Lease(*this, *std::move(connection));
    give_back(nullptr);
    return std::move(connection).error();
}

Result<std::unique_ptr<sql::Connection>> Readers::open(const LogMark& mark) {
    WEAVE_TRY(auto connection, sql::Connection::open(m_place, m_access));
    if (m_access != sql::Access::standby) WEAVE_CHECK_OK(mark.check(*connection));
    return connection;
}

/// None where a new one may be opened, which is counted already.
std::unique_ptr<sql::Connection> Readers::wait_for_one() {
    std::unique_lock lock(m_mutex);
    m_free.wait(lock, [this] { return !m_idle.empty() || m_open < most_readers; });
    if (m_idle.empty()) {
        ++m_open;
        return nullptr;
    }
    auto connection = std::move(m_idle.back());
    m_idle.pop_back();
    return connection;
}

void Readers::give_back(std::unique_ptr<sql::Connection> connection) {
    const std::lock_guard lock(m_mutex);
    if (connection)
        m_idle.push_back(std::move(connection));
    else
        --m_open;
    m_free.notify_one();
}

}  // namespace weave::loomlink
