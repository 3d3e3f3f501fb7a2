// migrate-store: a site's store from its file into a database, and back.

#include <weave/command/serving.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/private_file.hpp>

#include <loomlink/commands/command.hpp>
#include <loomlink/commands/site_copy.hpp>
#include <loomlink/store/copy.hpp>
#include <loomlink/store/server.hpp>
#include <memory>

namespace weave::loomlink {

namespace {

namespace fs = std::filesystem;

constexpr const char* as_a_file = "file";

/// The log as both stores must tell it.
struct LogFacts {
    std::uint64_t size = 0;
    std::string root;
    friend bool operator==(const LogFacts&, const LogFacts&) = default;
};

Result<LogFacts> log_facts(const std::string& store) {
    LogFacts facts;
    WEAVE_CHECK_OK(look_into(store, [&](const Reader& reader) -> Status {
        WEAVE_TRY(facts.size, reader.log_size());
        WEAVE_TRY(const Hash root, reader.root(facts.size));
        facts.root = hash_hex(root);
        return {};
    }));
    return facts;
}

/// The name by which the file that was the store until now stays, and nothing opens it.
fs::path aside_of(const std::string& file) {
    return file + ".moved";
}

/// Told before anything is done.
Status can_be_set_aside(const std::string& file) {
    std::error_code trouble;
    if (is_database(file) || !fs::exists(aside_of(file), trouble)) return {};
    return Error{ErrorCode::refused, "is in the way: put it elsewhere, it is the store of an earlier move", aside_of(file).string()};
}

Status set_aside(const std::string& file) {
    std::error_code trouble;
    fs::rename(file, aside_of(file), trouble);
    return trouble ? Status(system_fault("cannot be set aside: " + trouble.message(), file)) : Status();
}

/// From here on the folder names the new place. `store.url` wins over a file, so that no order of these steps leaves two.
Status switch_over(const SiteFolder& site, const std::string& from, const std::string& to) {
    if (is_database(to)) {
        WEAVE_CHECK_OK(write_private_file(site.store_place(), to + "\n"));
        return is_database(from) ? Status() : set_aside(from);
    }
    std::error_code trouble;
    fs::remove(site.store_place(), trouble);
    return trouble ? Status(system_fault("cannot be removed: " + trouble.message(), site.store_place().string())) : Status();
}

/// A program on another machine may have begun to serve a database meanwhile, whose writing would be left behind.
Status refuse_written_to(const std::string& from, const LogFacts& told) {
    WEAVE_CHECK_OK(refuse_in_use(from));
    WEAVE_TRY(const LogFacts now, log_facts(from));
    if (now == told) return {};
    return Error{ErrorCode::refused, "was written to meanwhile; stop every program that serves it. The site was left where it is", from};
}

Error not_as_written(const std::string& what, const AuditFinding& finding) {
    return {ErrorCode::refused, "is not as it was written: " + finding.text() + " (verify tells all)", what};
}

/// Whether the copy is what the site can go on with.
Status check_copy(const SiteFolder& site, const std::string& from, const std::string& to, const LogFacts& told) {
    WEAVE_TRY(const auto after, verify_site_in(site, to, {}));
    if (!after.empty()) return not_as_written(to, after.front());
    WEAVE_TRY(const LogFacts kept, log_facts(to));
    if (!(kept == told)) return system_fault("has another log than " + from + "; the site was left where it is", to);
    return refuse_written_to(from, told);
}

/// A move that was refused leaves nothing in the way of the next one.
Error without_copy(Error why, const std::string& to) {
    if (const Status removed = remove_copy(to); !removed)
        why.message += " (and the copy stays in " + to + ": " + removed.error().text() + ")";
    return why;
}

Status move_store(const SiteFolder& site, const std::string& wish, CommandOutcome& outcome) {
    if (!site.holds_site()) return bad_input("holds no store of loomlink", site.path.string());
    WEAVE_TRY(const FolderLock lock, FolderLock::take(site.path, "loomlink"));
    WEAVE_TRY(const std::string from, site.store());
    const std::string to = wish == as_a_file ? site.own_store().string() : wish;
    if (to != site.own_store().string() && !is_database(to))
        return bad_input("must be a connection string (postgresql://HOST/DATABASE), or the word file", "TO");
    if (from == to) return Error{ErrorCode::refused, "is where the store of this site is already", to};
    WEAVE_CHECK_OK(refuse_in_use(from));
    WEAVE_CHECK_OK(can_be_set_aside(from));
    WEAVE_TRY(const auto before, verify_site(site, {}));
    if (!before.empty()) return not_as_written(site.path.string(), before.front());
    WEAVE_TRY(const LogFacts told, log_facts(from));
    WEAVE_CHECK_OK(copy_store(from, to));
    if (Status good = check_copy(site, from, to, told); !good) return without_copy(std::move(good).error(), to);
    WEAVE_CHECK_OK(switch_over(site, from, to));
    outcome.answer({{"from", from}, {"to", to}, {"records", told.size}, {"root", told.root}},
                   on_one_line(site.path.string()) + ": the store is in " + to + " now, every row as it was: " +
                       std::to_string(told.size) + " records, root " + told.root + "\n");
    return {};
}

}  // namespace

void add_migrate_store_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(
        app, outcome, "migrate-store",
        "Move the store of a site, which must not be served, into an empty PostgreSQL database, or back into a file. Everything is "
        "verified before and after; where anything differs the site stays where it is. What was the store stays too: a file as "
        "loomlink.db.moved, a database as it is",
        "loomlink migrate-store /srv/mill postgresql://db.mill.example/mill");
    const auto folder = std::make_shared<std::string>();
    const auto to = std::make_shared<std::string>();
    add_text(command, "FOLDER", *folder, "the folder of the site")->required();
    add_text(command, "TO", *to,
             "connection string of the database (no password in it: passfile=… or PGPASSFILE), or file: the folder's own loomlink.db")
        ->required();
    on_run(command, outcome, [folder, to, &outcome] { return move_store({*folder}, *to, outcome); });
}

}  // namespace weave::loomlink
