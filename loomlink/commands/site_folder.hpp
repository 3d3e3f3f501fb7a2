#pragma once

#include <weave/command/serving.hpp>
#include <weave/net/certificate.hpp>

#include <array>
#include <filesystem>
#include <loomlink/commands/config.hpp>
#include <loomlink/store/store.hpp>
#include <loomlink/workflow/desk.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

/// Where things lie in the folder of a site.
struct SiteFolder {
    std::filesystem::path path;
    /// Its path from the root, to be told to people.
    [[nodiscard]] std::string whole_path() const;
    /// The store where nothing else is said: one file of SQLite.
    [[nodiscard]] std::filesystem::path own_store() const { return path / "loomlink.db"; }
    /// Holds the connection string of the database, where the store is one; it wins over a file.
    [[nodiscard]] std::filesystem::path store_place() const { return path / "store.url"; }
    /// Whether it holds a site, wherever its store is.
    [[nodiscard]] bool holds_site() const;
    /// Where the store is: a path or a connection string, for Store::open(). Errors: a `store.url` that is none.
    [[nodiscard]] Result<std::string> store() const;
    [[nodiscard]] std::filesystem::path log_key() const { return path / "log.key"; }
    [[nodiscard]] std::filesystem::path stamp_key() const { return path / "stamp.key"; }
    [[nodiscard]] std::filesystem::path access_key() const { return path / "access.key"; }
    [[nodiscard]] net::TlsFiles tls() const { return {path / "tls.pem", path / "tls.key"}; }
    /// All of them: the server's keys, and its certificate.
    [[nodiscard]] std::array<std::filesystem::path, 5> key_files() const {
        return {log_key(), stamp_key(), access_key(), tls().key, tls().certificate};
    }
};

/// Refused: a folder with anything in it but a site.
Status check_site_folder(const SiteFolder& folder);

/// Whether open_site() would open or make a site in a folder, as far as can be seen without doing it: the folder, its keys and
/// certificate, and its store or the database for a new one. Changes nothing.
Status check_site(const SiteFolder& folder, const ServeConfig& config);

/// A site that is open, for this process alone.
struct OpenSite {
    FolderLock lock;
    Store store;
    ServerKeys keys;
    std::string name;
    bool is_new = false;
};

/// Opens the site in a folder, or makes it where the folder is missing or empty: the store (in the database that
/// `config.store` names, else a file), and the keys for log, stamps and access tokens (mode 0600). The last is made anew where it is missing, since nothing that lasts is
/// signed with it. Errors: a folder that is missing with the one above it (bad_input); refused:
/// one that holds other things, or half a site; one whose store is elsewhere than `config.store` says.
Result<OpenSite> open_site(const SiteFolder& folder, const ServeConfig& config);

}  // namespace weave::loomlink
