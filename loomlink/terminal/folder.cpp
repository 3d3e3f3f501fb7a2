#include <loomlink/terminal/folder.hpp>

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <set>
#include <unistd.h>

namespace weave::loomlink {

namespace {

namespace fs = std::filesystem;

std::string shown(const fs::path& name) {
    return on_one_line(name.string());
}

/// What is wrong with one file, if anything. A link is no file: what it leads to may change unseen.
std::optional<FileFinding> look_at(const fs::path& file, std::uint64_t size, const std::string& sha256) {
    const std::string name = shown(file.filename());
    std::error_code code;
    const fs::file_status status = fs::symlink_status(file, code);
    if (status.type() == fs::file_type::not_found)
        return FileFinding{FileTrouble::missing, name, "is missing"};
    if (status.type() != fs::file_type::regular)
        return FileFinding{FileTrouble::not_a_file, name,
                           "is not a file of its own, but a link or something else"};
    const auto facts = fs::file_size(file, code);
    if (!code && facts != size)
        return FileFinding{FileTrouble::differs, name,
                           "differs: has " + counted(facts, "byte") + ", not " + std::to_string(size)};
    const auto bytes = read_file(file, size);
    if (!bytes) return FileFinding{FileTrouble::unreadable, name, bytes.error().message};
    if (sha256_hex(*bytes) != sha256)
        return FileFinding{FileTrouble::differs, name, "differs from what was signed"};
    return {};
}

/// Whether a manifest can be what people signed before it is read.
Status check_manifest_file(const fs::path& place) {
    std::error_code code;
    const fs::file_status status = fs::symlink_status(place, code);
    if (status.type() == fs::file_type::not_found)
        return bad_input("is not there: name the folder of one release, as pull made it", place.string());
    if (!fs::is_regular_file(status))
        return invalid("is not a file of its own, but a link or something else", place.string());
    const auto size = fs::file_size(place, code);
    if (code || size <= most_manifest_bytes) return {};
    return invalid("is too large for a manifest: " + counted(size, "byte"), place.string());
}

void look_for_more(const fs::path& folder, FolderReport& report) {
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        const auto& files = report.manifest.files;
        const bool listed =
            name == manifest_name ||
            std::any_of(files.begin(), files.end(), [&](const auto& file) { return file.path == name; });
        if (listed) continue;
        if (report.findings.size() >= most_folder_findings) {
            report.findings.push_back(
                {FileTrouble::too_many, "", "there are more findings than are told here"});
            return;
        }
        report.findings.push_back({FileTrouble::too_many, shown(name), "does not belong to the release"});
    }
    if (code)
        report.findings.push_back(
            {FileTrouble::unreadable, "", "the folder cannot be read: " + code.message()});
}

Error refused(const fs::path& path, std::string why) {
    return {ErrorCode::refused, std::move(why), path.string()};
}

/// The folder as it is found from anywhere. Errors: one that cannot be noted in a state, which is JSON.
Result<fs::path> whole_path(const fs::path& folder) {
    std::error_code code;
    fs::path whole = fs::absolute(folder, code);
    if (!code) whole = fs::weakly_canonical(whole, code);
    if (code) return system_fault("cannot be found: " + code.message(), folder.string());
    if (!is_utf8(whole.native())) return Error{ErrorCode::usage, "its name is not UTF-8", shown(folder)};
    return whole.has_filename() ? whole : whole.parent_path();
}

void remember(TerminalState& state, const CheckedRelease& release, const fs::path& within) {
    for (SeenRelease& seen : state.releases)
        if (seen.number == release.manifest.release)
            seen.body_sha256 = body_sha256(release.manifest.document);
    PlacedRelease placed{release.manifest.release, within, release.folder, {}};
    for (const PulledFile& file : release.files) placed.files.push_back({file.path, sha256_hex(file.bytes)});
    std::erase_if(state.placed, [&](const PlacedRelease& old) { return old.path() == placed.path(); });
    state.placed.push_back(std::move(placed));
}

/// Whether the folder holds exactly these files, byte for byte.
Status check_placed(const TrustDocument& trust, const CheckedRelease& release, const fs::path& folder) {
    const auto report = verify_files(folder, trust);
    if (!report && report.error().code == ErrorCode::system) return report.error();
    if (!report) return invalid(report.error().message, report.error().where);
    if (!report->findings.empty())
        return invalid(report->findings.front().path + ": " + report->findings.front().message,
                       folder.string());
    if (body_sha256(report->manifest.document) != body_sha256(release.manifest.document))
        return refused(folder, "holds another release");
    return {};
}

/// Where a release lies until it was read back.
fs::path incoming_folder(const fs::path& releases, const std::string& folder) {
    return releases / (".incoming-" + folder);
}

/// Gives the folder its name, and makes the name last.
Status put_into_place(const fs::path& made, const fs::path& folder) {
    if (::rename(made.c_str(), folder.c_str()) != 0)
        return system_fault(std::string("cannot put into place: ") + std::strerror(errno), folder.string());
    const int parent = ::open(folder.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (parent >= 0) {
        ::fsync(parent);
        ::close(parent);
    }
    return {};
}

const char* word_of(ReleaseState end) {
    return end == ReleaseState::withdrawn ? "withdrawn" : "superseded";
}

void remove_release(const PlacedRelease& placed, const std::string& how, RecallReport& report) {
    PlacedRelease rest{placed.number, placed.within, placed.folder, {}};
    const fs::path folder = placed.path();
    const auto keep_all = [&](FileTrouble trouble, const std::string& why) {
        report.kept.push_back({trouble, shown(folder), why});
        report.state.placed.push_back(placed);
    };
    std::error_code code;
    if (!fs::is_directory(placed.within, code))  // a stick that was pulled out comes back with what is on it
        return keep_all(FileTrouble::unreadable, "belongs to the " + how + " release " + std::to_string(placed.number) +
                                                     " but cannot be looked at: there is no folder " + shown(placed.within) +
                                                     ". Bring it back, or make it anew if it is gone for good, and pull again");
    fs::remove_all(incoming_folder(placed.within, placed.folder), code);
    if (fs::is_symlink(fs::symlink_status(folder, code)))
        return keep_all(FileTrouble::not_a_file, "is a link now; nothing behind it was touched");
    for (const PlacedFile& file : placed.files) {
        const fs::path path = folder / file.path;
        const std::string name = shown(path);
        const auto size = fs::file_size(path, code);
        auto finding = look_at(path, code ? 0 : size, file.sha256);
        if (finding && finding->trouble == FileTrouble::missing) continue;
        if (!finding && fs::remove(path, code)) {
            report.removed.push_back(name);
            continue;
        }
        const std::string why = finding ? finding->message : "cannot be removed: " + code.message();
        report.kept.push_back({finding ? finding->trouble : FileTrouble::unreadable, name,
                               "belongs to the " + how + " release " + std::to_string(placed.number) +
                                   " but was left: it " + why});
        rest.files.push_back(file);
    }
    if (fs::is_directory(folder, code) && fs::is_empty(folder, code)) fs::remove(folder, code);
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        const bool told = std::any_of(rest.files.begin(), rest.files.end(),
                                      [&](const PlacedFile& file) { return file.path == name; });
        if (!told)
            report.kept.push_back(
                {FileTrouble::too_many, shown(entry->path()),
                 "lies in the folder of a " + how + " release but was not put there by this terminal"});
    }
    if (!rest.files.empty()) report.state.placed.push_back(std::move(rest));
}

}  // namespace

Result<fs::path> place_release(TerminalState& state, const CheckedRelease& release,
                               const fs::path& state_file, const fs::path& releases) {
    WEAVE_TRY(const fs::path within, whole_path(releases));
    remember(state, release, within);
    WEAVE_CHECK_OK(save_state(state_file, state));
    fs::path folder = releases / release.folder;
    std::error_code code;
    if (fs::exists(fs::symlink_status(folder, code))) {
        Status as_signed = check_placed(state.trust, release, folder);
        if (as_signed) return folder;
        Error trouble = std::move(as_signed).error();
        trouble.message += "; move that folder away and pull again";
        return trouble;
    }
    const fs::path incoming = incoming_folder(releases, release.folder);
    fs::remove_all(incoming, code);  // what an earlier try left when the power failed
    std::vector<std::pair<std::string, std::string>> files;
    for (const PulledFile& file : release.files) files.emplace_back(file.path, file.bytes);
    WEAVE_CHECK_OK(write_folder(incoming, files));
    Status put = check_placed(state.trust, release, incoming);
    if (put) put = put_into_place(incoming, folder);
    if (!put) {
        fs::remove_all(incoming, code);
        return std::move(put).error();
    }
    return folder;
}

Result<FolderReport> verify_files(const fs::path& folder, const TrustDocument& trust) {
    const fs::path place = folder / manifest_name;
    WEAVE_CHECK_OK(check_manifest_file(place));
    WEAVE_TRY(const std::string bytes, read_file(place, most_manifest_bytes));
    auto manifest = check_manifest(bytes, trust);
    if (!manifest) return std::move(manifest).error().in(place.string());
    FolderReport report{std::move(*manifest), {}};
    for (const ReleasedFile& file : report.manifest.files)
        if (auto finding = look_at(folder / file.path, file.size, file.sha256))
            report.findings.push_back(*finding);
    look_for_more(folder, report);
    return report;
}

Status check_recall(const TerminalState& state, const ReleaseManifest& manifest) {
    const auto no = [&](std::string why) {
        return Error{ErrorCode::refused, "release " + std::to_string(manifest.release) + " " + std::move(why),
                     "manifest"};
    };
    if (manifest.loom != state.loom)
        return no("is for the loom '" + manifest.loom + "', not for '" + state.loom + "'");
    for (const SeenRelease& seen : state.releases) {
        if (seen.number != manifest.release) continue;
        const bool other = seen.revision_sha256 != manifest.revision_sha256 ||
                           (!seen.body_sha256.empty() && seen.body_sha256 != body_sha256(manifest.document));
        if (other) return no("is another one than this terminal has seen under this number");
        if (seen.state == ReleaseState::withdrawn) return no("was withdrawn: it must not be woven");
        if (seen.state == ReleaseState::superseded) return no("was superseded: by a newer release, or by another profile of the loom");
    }
    return {};
}

RecallReport remove_ended(const TerminalState& state, ReleaseState end) {
    RecallReport report{{}, {}, state};
    report.state.placed.clear();
    for (const PlacedRelease& placed : state.placed) {
        const bool has_ended =
            std::any_of(state.releases.begin(), state.releases.end(), [&](const SeenRelease& seen) {
                return seen.number == placed.number && seen.state == end;
            });
        if (has_ended)
            remove_release(placed, word_of(end), report);
        else
            report.state.placed.push_back(placed);
    }
    return report;
}

bool lies_in(const PlacedRelease& placed, const fs::path& releases) {
    const auto whole = whole_path(releases);
    return whole && placed.within == *whole;
}

std::vector<FileFinding> foreign_releases(const TerminalState& before, const TerminalState& after, const fs::path& releases) {
    std::set<std::string> known;
    for (const auto* state : {&before, &after})
        for (const PlacedRelease& placed : state->placed)
            if (lies_in(placed, releases)) known.insert(placed.folder);
    std::vector<FileFinding> found;
    std::error_code code;
    for (fs::directory_iterator entry(releases, code), end; !code && entry != end && found.size() < most_folder_findings; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with("release-") && entry->is_directory(code) && !known.contains(name))
            found.push_back({FileTrouble::too_many, shown(entry->path()),
                             "was not put there by this terminal for the loom '" + after.loom +
                                 "': a copy, or another loom's, which has a folder of its own. Take it away"});
    }
    return found;
}

}  // namespace weave::loomlink
