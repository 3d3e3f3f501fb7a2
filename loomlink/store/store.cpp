#include <loomlink/store/store.hpp>

#include <weave/sql/database.hpp>

#include <condition_variable>
#include <loomlink/store/backup.hpp>
#include <loomlink/store/commit_queue.hpp>
#include <loomlink/store/migrations.hpp>
#include <mutex>

namespace weave::loomlink {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_readers = 8;

/// A transaction that only reads; over at the end of its scope.
class ReadView {
  public:
    explicit ReadView(sql::Connection& connection) : m_connection(connection) {}
    ~ReadView() {
        if (m_connection.in_transaction()) static_cast<void>(m_connection.script("ROLLBACK"));
    }
    ReadView(const ReadView&) = delete;
    ReadView& operator=(const ReadView&) = delete;
    Status begin() { return m_connection.script("BEGIN"); }

  private:
    sql::Connection& m_connection;
};

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
    Core(std::string path, std::unique_ptr<sql::Connection> writer)
        : m_path(path), m_queue(std::move(path), std::move(writer)) {}

    Status commit(const std::function<Status(Writer&)>& change) { return m_queue.commit(change); }

    [[nodiscard]] Status last_write() const { return m_queue.last_write(); }

    Status view(const std::function<Status(const Reader&)>& ask) {
        WEAVE_TRY(auto connection, take_reader());
        Status status;
        {
            ReadView transaction(*connection);
            status = transaction.begin();
            if (status) status = call(ask, Reader(*connection));
        }
        give_back(std::move(connection));
        return status;
    }

    [[nodiscard]] const std::string& path() const { return m_path; }

  private:
    /// A reader that is free, a new one, or the next that becomes free.
    Result<std::unique_ptr<sql::Connection>> take_reader() {
        std::unique_lock lock(m_mutex);
        m_free.wait(lock, [this] { return !m_readers.empty() || m_open < most_readers; });
        if (!m_readers.empty()) {
            auto connection = std::move(m_readers.back());
            m_readers.pop_back();
            return connection;
        }
        ++m_open;
        lock.unlock();
        auto connection = sql::Connection::open(m_path, sql::Access::read);
        if (!connection) give_back(nullptr);
        return connection;
    }
    void give_back(std::unique_ptr<sql::Connection> connection) {
        const std::lock_guard lock(m_mutex);
        if (connection)
            m_readers.push_back(std::move(connection));
        else
            --m_open;
        m_free.notify_one();
    }

    std::string m_path;
    std::mutex m_mutex;
    std::condition_variable m_free;
    std::vector<std::unique_ptr<sql::Connection>> m_readers;
    std::size_t m_open = 0;
    CommitQueue m_queue;
};

Store::Store(std::unique_ptr<Core> core) : m_core(std::move(core)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

Result<Store> Store::create(const fs::path& path, const std::string& site) {
    const auto fill = [&](const std::string& temporary) -> Status {
        WEAVE_TRY(auto connection, sql::Connection::open(temporary, sql::Access::create));
        WEAVE_CHECK_OK(sql::migrate(*connection, migrations(), store_owner));
        return connection->run("INSERT INTO site (one, name) VALUES (1, ?)", site);
    };
    WEAVE_CHECK_OK(make_database(path, fill));
    return open(path);
}

Result<Store> Store::open(const fs::path& path) {
    WEAVE_TRY(auto connection, sql::Connection::open(path.string(), sql::Access::write));
    Status status = sql::migrate(*connection, migrations(), store_owner);
    if (!status) return std::move(status).error().in(path.string());
    WEAVE_CHECK_OK(Reader(*connection).site());
    return Store(std::make_unique<Core>(path.string(), std::move(connection)));
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

Status Store::backup(const fs::path& to) const {
    return copy_database(m_core->path(), to);
}

}  // namespace weave::loomlink
