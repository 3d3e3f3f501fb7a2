#include <loomlink/commands/site_copy.hpp>

#include <weave/core/descriptor.hpp>
#include <weave/core/file.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/secret_bytes.hpp>
#include <weave/keys/server_key.hpp>

#include <csignal>
#include <fcntl.h>
#include <loomlink/store/signatures.hpp>
#include <loomlink/workflow/retelling.hpp>
#include <sys/stat.h>
#include <unistd.h>

namespace weave::loomlink {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_key_file = 65536;

Status check_store_is_there(const SiteFolder& site) {
    if (site.holds_site()) return {};
    return bad_input("holds no store of loomlink", site.path.string());
}

void look_at_key(const Result<KeyPair>& key, const fs::path& file, std::vector<AuditFinding>& findings) {
    if (!key) findings.push_back({{}, file.filename().string(), key.error().message});
}

/// A site that was served with a certificate of its own has both of its files.
void look_at_certificate(const net::TlsFiles& tls, std::vector<AuditFinding>& findings) {
    std::error_code code;
    if (!fs::exists(tls.certificate, code) && !fs::exists(tls.key, code)) return;
    if (const auto facts = net::read_certificate(tls.certificate); !facts)
        findings.push_back({{}, tls.certificate.filename().string(), facts.error().message});
    if (const Status sealed = check_private_file(tls.key); !sealed)
        findings.push_back({{}, tls.key.filename().string(), sealed.error().message});
}

/// Copies a small file for its owner alone; one that is missing is left out, one that is there stays.
Status copy_private(const fs::path& from, const fs::path& to) {
    std::error_code code;
    if (!fs::exists(from, code) || fs::exists(fs::symlink_status(to, code))) return {};
    WEAVE_TRY(std::string bytes, read_file(from, most_key_file));
    Status made = create_private_file(to, bytes);
    wipe(bytes);
    return made;
}

/// A folder that is being made; it goes unless it was put into place.
class NewFolder {
  public:
    explicit NewFolder(fs::path path) : m_path(std::move(path)) {}
    ~NewFolder() {
        std::error_code ignored;
        fs::remove_all(m_path, ignored);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return m_path; }

    Status make() const {
        return ::mkdir(m_path.c_str(), 0700) == 0 ? Status() : Status(file_fault(m_path, "make the folder"));
    }
    /// Replaces nothing.
    [[nodiscard]] Status put(const fs::path& to) const {
        if (::renameat2(AT_FDCWD, m_path.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) != 0)
            return file_fault(to, "put into place");
        const fs::path above = to.has_parent_path() ? to.parent_path() : fs::path(".");
        const Descriptor folder(::open(above.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        if (folder.number() >= 0) ::fsync(folder.number());
        return {};
    }

  private:
    fs::path m_path;
};

/// Signals that end the program wait while this lives, so that no half copy of the server's keys stays behind.
class SignalsHeld {
  public:
    SignalsHeld() {
        sigemptyset(&m_ending);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&m_ending, signal);
        pthread_sigmask(SIG_BLOCK, &m_ending, &m_before);
    }
    ~SignalsHeld() { pthread_sigmask(SIG_SETMASK, &m_before, nullptr); }
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;
    [[nodiscard]] bool one_waits() const {
        sigset_t waiting;
        sigpending(&waiting);
        return sigismember(&waiting, SIGINT) == 1 || sigismember(&waiting, SIGTERM) == 1 ||
               sigismember(&waiting, SIGHUP) == 1;
    }

  private:
    sigset_t m_ending{}, m_before{};
};

/// The folder as a name to put another one beside.
fs::path without_slash(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace

Result<std::vector<AuditFinding>> verify_site(const SiteFolder& site,
                                              const std::optional<SignedTreeHead>& retained) {
    WEAVE_CHECK_OK(check_store_is_there(site));
    WEAVE_TRY(const std::string store, site.store());
    return verify_site_in(site, store, retained);
}

Result<std::vector<AuditFinding>> verify_site_in(const SiteFolder& site, const std::string& store,
                                                 const std::optional<SignedTreeHead>& retained) {
    std::vector<AuditFinding> findings;
    const auto log = load_server_key(site.log_key(), ServerKeyRole::log);
    look_at_key(log, site.log_key(), findings);
    look_at_key(load_server_key(site.stamp_key(), ServerKeyRole::stamp), site.stamp_key(), findings);
    std::error_code code;
    if (fs::exists(fs::symlink_status(site.access_key(), code)))  // serving makes it where it is missing
        look_at_key(load_server_key(site.access_key(), ServerKeyRole::access), site.access_key(), findings);
    look_at_certificate(site.tls(), findings);
    StoreTrust trust;
    if (log) {
        auto own = own_trust(store, log->public_key());
        if (own)
            trust = *std::move(own);
        else
            findings.push_back({{}, "store", own.error().text()});
    }
    trust.retained = retained;
    WEAVE_TRY(const auto in_store, verify_store(store, trust));
    findings.insert(findings.end(), in_store.begin(), in_store.end());
    for (const auto& looked_at : {verify_signatures(store), verify_tables(store)})
        if (looked_at)
            findings.insert(findings.end(), looked_at->begin(), looked_at->end());
        else
            findings.push_back({{}, "store", looked_at.error().text()});
    return findings;
}

Status copy_keys(const SiteFolder& from, const SiteFolder& to) {
    const auto targets = to.key_files();
    for (std::size_t k = 0; const fs::path& source : from.key_files()) WEAVE_CHECK_OK(copy_private(source, targets[k++]));
    return {};
}

Status back_up_site(const SiteFolder& site, const fs::path& to) {
    WEAVE_CHECK_OK(check_store_is_there(site));
    const fs::path target = without_slash(to);
    std::error_code code;
    if (fs::exists(fs::symlink_status(target, code)))
        return Error{ErrorCode::refused, "exists already", target.string()};
    const SignalsHeld held;
    const NewFolder made(target.string() + ".part-" + std::to_string(::getpid()));
    WEAVE_CHECK_OK(made.make());
    const SiteFolder copy{made.path()};
    WEAVE_TRY(const std::string store, site.store());
    WEAVE_CHECK_OK(back_up_store(store, copy.own_store()));
    WEAVE_CHECK_OK(copy_keys(site, copy));
    if (held.one_waits()) return system_fault("was asked to end; nothing was made", target.string());
    return made.put(target);
}

}  // namespace weave::loomlink
