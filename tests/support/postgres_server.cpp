#include <support/postgres_server.hpp>

#include <weave/sql/database.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <pwd.h>
#include <sched.h>
#include <stdexcept>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace weave::testing {

namespace {

namespace fs = std::filesystem;

constexpr int most_waits = 3000;
constexpr std::chrono::milliseconds pause{20};

std::string program(const char* name) {
    return std::string(WEAVE_POSTGRES_BIN) + "/" + name;
}

/// The server refuses to be root.
const passwd* servant() {
    return ::geteuid() == 0 ? ::getpwnam("postgres") : nullptr;
}

/// Starts a program as the servant, in a group of its own; it does not outlive the test.
pid_t spawn(std::vector<std::string> words, const fs::path& log) {
    const passwd* const user = servant();
    std::string path = "PATH=/usr/bin:/bin", locale = "LC_ALL=C", shim = "LD_PRELOAD=" + (log.parent_path() / "full_disk.so").string(),
                full = "WEAVE_FULL_DISK=" + (log.parent_path() / "full").string();
    char* environment[]{path.data(), locale.data(), shim.data(), full.data(), nullptr};
    std::vector<char*> list;
    for (auto& word : words) list.push_back(word.data());
    list.push_back(nullptr);
    const pid_t process = ::fork();
    if (process != 0) return process;
    ::setpgid(0, 0);
    const int out = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    ::dup2(out, 1);
    ::dup2(out, 2);
    if (user != nullptr && (::setgid(user->pw_gid) != 0 || ::setuid(user->pw_uid) != 0)) ::_exit(126);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::close_range(3, ~0U, 0);
    ::execve(list.front(), list.data(), environment);
    ::_exit(127);
}

void run_to_end(const std::vector<std::string>& words, const fs::path& log) {
    int status = 0;
    ::waitpid(spawn(words, log), &status, 0);
    if (status == 0) return;
    std::ifstream told(log);
    throw std::runtime_error(words.front() + " failed: " + std::string(std::istreambuf_iterator<char>(told), {}));
}

std::unique_ptr<sql::Connection> connect(const std::string& place) {
    auto opened = sql::Connection::open(place, sql::Access::standby);  // a standby answers too
    if (!opened) throw std::runtime_error(opened.error().text());
    return *std::move(opened);
}

std::string joined(const std::string& database, const std::string& hosts) {
    return "postgresql:///" + database + "?user=postgres&host=" + hosts;
}

}  // namespace

bool PostgresServer::is_installed() {
    return *WEAVE_POSTGRES_BIN != '\0' && (::geteuid() != 0 || servant() != nullptr);
}

PostgresServer& PostgresServer::shared() {
    static PostgresServer server;
    return server;
}

PostgresServer::PostgresServer() {
    make_folder();
    run_to_end({program("initdb"), "-D", m_folder / "data", "-U", "postgres", "-A", "trust", "-E", "UTF8", "--locale", "C", "--no-sync",
                "--no-instructions"},
               m_folder / "log");
    write_settings();
    start();
}

PostgresServer::PostgresServer(const PostgresServer& primary, const std::string& name) {
    make_folder();
    run_to_end({program("pg_basebackup"), "-D", m_folder / "data", "-h", primary.m_folder, "-U", "postgres", "-c", "fast", "--no-sync", "-R", "-X",
                "stream", "-d", "application_name=" + name},
               m_folder / "log");
    write_settings();
    start();
}

PostgresServer::~PostgresServer() {
    kill();
    if (!m_log_disk.empty()) ::umount2(m_log_disk.c_str(), MNT_DETACH);
    std::error_code ignored;
    fs::remove_all(m_folder, ignored);
}

void PostgresServer::make_folder() {
    if (!is_installed()) throw std::runtime_error("there is no PostgreSQL server here");
    std::string name = (fs::temp_directory_path() / "weave-pg-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for a server");
    m_folder = name;
    fs::copy_file(WEAVE_FULL_DISK_SHIM, m_folder / "full_disk.so");  // from where its user may read it
    if (const passwd* const user = servant())
        if (::chown(m_folder.c_str(), user->pw_uid, user->pw_gid) != 0) throw std::runtime_error("the folder cannot be given away");
}

void PostgresServer::write_settings() const {
    configure("listen_addresses = ''\nunix_socket_directories = '" + m_folder.string() +
              "'\nfsync = off\nmax_connections = 60\nshared_buffers = 16MB\nwal_keep_size = 256MB\nwal_log_hints = on\nautovacuum = "
              "off\nlog_min_messages = fatal\nwal_receiver_status_interval = 1s\nwal_retrieve_retry_interval = 100ms\n");
}

void PostgresServer::configure(const std::string& lines) const {
    std::ofstream(m_folder / "data" / "postgresql.conf", std::ios::app) << lines << '\n';
}

void PostgresServer::reload() const {
    ::kill(m_process, SIGHUP);
}

std::string PostgresServer::place(const std::string& database, const std::string& user) const {
    return "postgresql:///" + database + "?user=" + user + "&host=" + m_folder.string();
}

std::string PostgresServer::place_with(const PostgresServer& other, const std::string& database) const {
    return joined(database, m_folder.string() + "," + other.m_folder.string());
}

std::string PostgresServer::make_database() {
    const std::string name = "store_" + std::to_string(++m_databases);
    run("CREATE DATABASE " + name);
    return name;
}

std::string PostgresServer::copy_database(const std::string& from) {
    const std::string name = "store_" + std::to_string(++m_databases);
    run("CREATE DATABASE " + name + " TEMPLATE " + from);
    return name;
}

void PostgresServer::drop_database(const std::string& name) {
    run("DROP DATABASE IF EXISTS " + name + " WITH (FORCE)");
}

void PostgresServer::run(const std::string& script, const std::string& database) const {
    const auto connection = connect(place(database));
    static_cast<void>(connection->script("SET default_transaction_read_only = off"));
    if (const Status ran = connection->script(script); !ran) throw std::runtime_error(ran.error().text());
}

std::int64_t PostgresServer::number(const std::string& question, const std::string& database) const {
    auto found = connect(place(database))->number(question);
    if (!found) throw std::runtime_error(found.error().text());
    return *found;
}

void PostgresServer::start() {
    m_process = spawn({program("postgres"), "-D", m_folder / "data"}, m_folder / "log");
    wait_until("SELECT 1");
}

void PostgresServer::wait_until(const std::string& question) const {
    for (int waits = 0; waits < most_waits; ++waits) {
        if (const auto opened = sql::Connection::open(place(), sql::Access::standby))
            if (const auto found = (*opened)->number(question); found && *found != 0) return;
        std::this_thread::sleep_for(pause);
    }
    std::ifstream told(m_folder / "log");
    throw std::runtime_error("the server does not come to " + question + ": " + std::string(std::istreambuf_iterator<char>(told), {}));
}

void PostgresServer::kill() {
    if (m_process <= 0) return;
    // Each child is in a session of its own and would finish what it is at: all of them go at once.
    ::kill(m_process, SIGSTOP);
    const std::string number = std::to_string(m_process);
    std::ifstream children("/proc/" + number + "/task/" + number + "/children");
    for (pid_t child = 0; children >> child;) ::kill(child, SIGKILL);
    ::kill(m_process, SIGKILL);
    ::waitpid(m_process, nullptr, 0);
    m_process = 0;
}

void PostgresServer::stop() {
    ::kill(m_process, SIGINT);
    // A server whose log's disk is full may wait for ever for its last checkpoint.
    for (int wait = 0; wait < 300; ++wait) {
        if (::waitpid(m_process, nullptr, WNOHANG) == m_process) {
            m_process = 0;
            return;
        }
        ::usleep(100'000);
    }
    kill();
}

/// What is mounted is seen by this thread and what it starts alone, and is gone with them, however they end.
std::filesystem::path PostgresServer::move_log_to_small_disk() {
    const fs::path disk = m_folder / "wal", log = m_folder / "data" / "pg_wal";
    fs::create_directories(disk);
    const passwd* const user = servant();
    const std::string options = "size=80m,mode=0700" + (user == nullptr ? "" : ",uid=" + std::to_string(user->pw_uid) + ",gid=" + std::to_string(user->pw_gid));
    if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", "none", MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("none", disk.c_str(), "tmpfs", 0, options.c_str()) != 0)
        return {};
    m_log_disk = disk;
    stop();
    run_to_end({"/bin/sh", "-c", "mv \"$0\" \"$1/log\" && ln -s \"$1/log\" \"$0\"", log, disk}, m_folder / "log");
    configure("wal_keep_size = 0\nmin_wal_size = 32MB\nmax_wal_size = 32MB");
    start();
    return disk;
}

void PostgresServer::cut_off() const {
    run("ALTER SYSTEM SET primary_conninfo = ''");
    reload();
    for (int waits = 0; waits < most_waits && number("SELECT count(*) FROM pg_stat_wal_receiver") > 0; ++waits)
        std::this_thread::sleep_for(pause);
}

void PostgresServer::promote() {
    run_to_end({program("pg_ctl"), "-D", m_folder / "data", "-W", "promote"}, m_folder / "log");
    wait_until("SELECT CASE WHEN pg_is_in_recovery() THEN 0 ELSE 1 END");
}

}  // namespace weave::testing
