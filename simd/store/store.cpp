#include <simd/store/store.hpp>

#include <weave/core/log.hpp>
#include <weave/sql/database.hpp>

#include <exception>
#include <simd/store/migrations.hpp>
#include <utility>

namespace weave::simd {

namespace {

/// The texts of answers are the caller's code: what it throws must not leave a transaction open.
Status call(const std::function<Status(sql::Connection&)>& change, sql::Connection& connection) {
    try {
        return change(connection);
    } catch (const std::exception& trouble) {
        return system_fault(std::string("a change of the store failed: ") + trouble.what());
    } catch (...) {
        return system_fault("a change of the store failed");
    }
}

/// The daemon alone has its file open. Two of them would each take the other's running jobs for left behind.
Status keep_to_ourselves(sql::Connection& connection, const std::string& path) {
    WEAVE_CHECK_OK(connection.script("PRAGMA locking_mode = EXCLUSIVE"));
    WEAVE_TRY(const auto mode,
              connection.one("PRAGMA journal_mode = WAL", [](const sql::Row& row) { return row.bytes(0); }));
    if (mode != "wal") return system_fault("cannot be made durable here (WAL)", path);
    return {};
}

}  // namespace

Store::Store(std::filesystem::path path) : m_path(std::move(path)) {}
Store::~Store() = default;

Result<std::unique_ptr<Store>> Store::open(const std::filesystem::path& path) {
    std::unique_ptr<Store> store(new Store(path));
    WEAVE_CHECK_OK(store->connect(true));
    Status migrated = sql::migrate(*store->m_connection, migrations(), store_owner);
    if (!migrated) return std::move(migrated).error().in(path.string());
    WEAVE_CHECK_OK(store->write([](sql::Connection& opened) {
        return opened.run("UPDATE job SET phase = 'waiting' WHERE phase = 'running'");
    }));
    return store;
}

Status Store::connect(bool may_make) {
    const sql::Access access = may_make ? sql::Access::create : sql::Access::write;
    WEAVE_TRY(auto opened, sql::Connection::open(m_path.string(), access, std::chrono::milliseconds(0)));
    WEAVE_CHECK_OK(keep_to_ourselves(*opened, m_path.string()));
    m_connection = std::move(opened);
    return {};
}

/// Opens the file anew after its disk failed.
Result<sql::Connection*> Store::connection() {
    if (!m_connection) WEAVE_CHECK_OK(connect(false));
    return m_connection.get();
}

Status Store::write(const Change& change) {
    const std::lock_guard lock(m_mutex);
    const auto connected = connection();
    if (!connected) return *(m_trouble = connected.error());
    sql::Connection* const connection = *connected;
    Status status = connection->script("BEGIN IMMEDIATE");
    if (status) status = call(change, *connection);
    if (status) status = connection->script("COMMIT");
    status = settled(std::move(status));
    m_trouble.reset();
    if (status && std::exchange(m_failure_told, false)) log(LogLevel::info, "the store takes everything again");
    if (!status && status.error().code == ErrorCode::system) m_trouble = status.error();
    return status;
}

Status Store::last_write() {
    const std::lock_guard lock(m_mutex);
    return m_trouble ? Status(*m_trouble) : Status();
}

Status Store::read(const Change& ask) {
    const std::lock_guard lock(m_mutex);
    WEAVE_TRY(sql::Connection* const connection, this->connection());
    return settled(ask(*connection));
}

/// Leaves no transaction open, and no connection whose disk has failed: what it holds in its cache is not to
/// be trusted.
Status Store::settled(Status outcome) {
    if (outcome) return outcome;
    if (m_connection->in_transaction()) static_cast<void>(m_connection->script("ROLLBACK"));
    if (outcome.error().code == ErrorCode::system) {
        if (!std::exchange(m_failure_told, true)) log(LogLevel::warning, "the store failed, and is tried again: " + outcome.error().text());
        m_connection.reset();
    }
    return outcome;
}

}  // namespace weave::simd
