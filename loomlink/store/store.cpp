#include <loomlink/store/store.hpp>

#include <weave/core/log.hpp>
#include <weave/sql/database.hpp>

#include <atomic>
#include <loomlink/store/backup.hpp>
#include <loomlink/store/commit_queue.hpp>
#include <loomlink/store/copy.hpp>
#include <loomlink/store/migrations.hpp>
#include <loomlink/store/reach.hpp>
#include <loomlink/store/readers.hpp>
#include <loomlink/store/server.hpp>

namespace weave::loomlink {

namespace {

Status call(const std::function<Status(const Reader&)>& ask, const Reader& reader) {
    try {
        return ask(reader);
    } catch (const std::exception& trouble) {
        return system_fault(std::string("a question to the store failed: ") + trouble.what());
    } catch (...) {
        return system_fault("a question to the store failed");
    }
}

}  // namespace

class Store::Core {
  public:
    Core(const std::string& place, std::unique_ptr<sql::Connection> writer, const std::string& standby,
         const std::optional<LogMark::Record>& newest)
        : m_readers(place, sql::Access::read), m_queue(place, std::move(writer), m_mark) {
        m_mark.set(newest);
        if (!standby.empty()) m_standby.emplace(standby, sql::Access::standby);
    }

    Status commit(const std::function<Status(Writer&)>& change) { return m_queue.commit(change); }

    [[nodiscard]] Status last_write() const { return m_queue.last_write(); }

    Status view(const std::function<Status(const Reader&)>& ask) {
        if (m_standby)
            if (const auto lease = take_standby()) return call(ask, Reader(lease->connection()));
        const auto lease = m_readers.take(m_mark);
        if (!lease) return lease.error().code == ErrorCode::system ? lost_store(Lost::before, lease.error()) : lease.error();
        Status asked = lease->connection().begin_read();
        if (asked) asked = call(ask, Reader(lease->connection()));
        return asked || lease->connection().is_usable() ? asked : lost_store(Lost::before, asked.error());
    }

  private:
    /// The standby with a view that holds all that was acknowledged before, by whomever; else the reason is logged, once.
    std::optional<Readers::Lease> take_standby() {
        auto lease = try_standby();
        if (lease && m_is_behind.exchange(false)) log(LogLevel::info, "views are read from the standby again");
        if (!lease && !m_is_behind.exchange(true))
            log(LogLevel::warning, "views are read from the primary: the standby " + lease.error().text());
        return lease ? std::optional(std::move(lease).value()) : std::nullopt;
    }
    Result<Readers::Lease> try_standby() {
        WEAVE_TRY(auto lease, m_standby->take(m_mark));
        {
            WEAVE_TRY(const auto primary, m_readers.take(m_mark));
            WEAVE_TRY(const bool caught_up, catches_up(lease.connection(), primary.connection()));
            if (!caught_up) return system_fault("lags behind the primary");
        }
        WEAVE_CHECK_OK(lease.connection().begin_read());
        WEAVE_CHECK_OK(m_mark.check(lease.connection()));
        return lease;
    }

    LogMark m_mark;
    Readers m_readers;
    std::optional<Readers> m_standby;
    std::atomic<bool> m_is_behind = false;
    CommitQueue m_queue;
};

Store::Store(std::unique_ptr<Core> core) : m_core(std::move(core)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

namespace {

/// Tables, and the site that they are of.
Status fill(sql::Connection& connection, const std::string& site) {
    WEAVE_CHECK_OK(sql::migrate(connection, migrations(connection.engine()), store_owner));
    return connection.run("INSERT INTO site (one, name) VALUES (1, ?)", site);
}

Status create_file(const std::string& path, const std::string& site) {
    return make_database(path, [&](const std::string& temporary) -> Status {
        WEAVE_TRY(const auto connection, sql::Connection::open(temporary, sql::Access::create));
        return fill(*connection, site);
    });
}

Status create_on_server(const std::string& place, const std::string& site) {
    WEAVE_TRY(const auto connection, open_writer(place, {}));
    if (Status filled = fill(*connection, site); !filled) return std::move(filled).error().in("the database for the store");
    return {};
}

}  // namespace

Result<Store> Store::create(const std::string& place, const std::string& site) {
    WEAVE_CHECK_OK(is_database(place) ? create_on_server(place, site) : create_file(place, site));
    return open(place);
}

Result<Store> Store::open(const std::string& place, const std::string& standby) {
    WEAVE_TRY(auto connection, open_writer(place, {}));
    Status status = sql::migrate(*connection, migrations(connection->engine()), store_owner);
    if (!status) return std::move(status).error().in(place);
    WEAVE_CHECK_OK(Reader(*connection).site());
    WEAVE_TRY(const auto newest, LogMark::newest(*connection));
    return Store(std::make_unique<Core>(place, std::move(connection), standby, newest));
}

Status check_store(const std::string& place, bool is_new) {
    WEAVE_TRY(const auto connection, open_writer(place, {}));
    if (Status known = sql::can_migrate(*connection, migrations(connection->engine()), store_owner); !known)
        return std::move(known).error().in(place);
    if (!is_new) return {};
    WEAVE_TRY(const bool is_empty, connection->is_empty());
    return is_empty ? Status() : Error{ErrorCode::refused, "the database is not empty", place};
}

Status Store::commit(const std::function<Status(Writer&)>& change) {
    return m_core->commit(change);
}

Status Store::view(const std::function<Status(const Reader&)>& ask) const {
    return m_core->view(ask);
}

Status Store::last_write() const {
    return m_core->last_write();
}

Status back_up_store(const std::string& place, const std::filesystem::path& to) {
    return is_database(place) ? copy_store(place, to.string()) : copy_database(place, to);
}

}  // namespace weave::loomlink
