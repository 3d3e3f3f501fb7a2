#include <weave/wire/mill_session.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/wire/place.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sys/stat.h>

namespace weave::wire {

namespace fs = std::filesystem;

namespace {

constexpr const char* format = "loomlink-session";
constexpr std::size_t most_bytes = 16384, longest_text = 2048;

Result<MillSession> read_session(std::string_view bytes) {
    WEAVE_TRY(const Json json, parse_json(bytes));
    JsonReader reader(json, "");
    MillSession session;
    if (reader.text("format", std::string()) != format) reader.fail("is no session of loomlink", "format");
    static_cast<void>(reader.integer("version", 1, 1));
    session.origin = reader.text("origin", {}, longest_text);
    session.fingerprint = reader.text("fingerprint", {}, longest_text);
    session.name = reader.text("name", {}, longest_text);
    session.token = reader.text("token", {}, longest_text);
    session.site = reader.text("site", {}, longest_text);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return session;
}

}  // namespace

Result<fs::path> user_folder(const char* variable, const char* usual) {
    const char* const named = std::getenv(variable);
    if (named != nullptr && fs::path(named).is_absolute()) return fs::path(named);
    const char* const home = std::getenv("HOME");
    if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / usual;
    return Error{ErrorCode::usage, std::string("there is no home folder and no $") + variable, ""};
}

Result<fs::path> usual_session_file() {
    WEAVE_TRY(const fs::path folder, user_folder("XDG_CONFIG_HOME", ".config"));
    return folder / "loomlink" / "session.json";
}

Status make_folders_for(const fs::path& file) {
    fs::path whole;
    for (const fs::path& part : file.parent_path()) {
        whole /= part;
        if (::mkdir(whole.c_str(), 0700) != 0 && errno != EEXIST)
            return system_fault(std::string("cannot make the folder: ") + std::strerror(errno),
                                whole.string());
    }
    return {};
}

Status save_session(const fs::path& file, const MillSession& session) {
    WEAVE_CHECK_OK(make_folders_for(file));
    const Json json{{"format", format},         {"version", 1},
                    {"origin", session.origin}, {"fingerprint", session.fingerprint},
                    {"name", session.name},     {"token", session.token},
                    {"site", session.site}};
    return write_private_file(file, json.dump(1, ' ', true, Json::error_handler_t::replace) + "\n");
}

Result<MillSession> load_session(const fs::path& file) {
    std::error_code code;
    if (!fs::exists(fs::symlink_status(file, code))) return MillSession{};
    WEAVE_TRY(const SecretBytes bytes, read_private_file(file, most_bytes));
    auto session = read_session({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (!session) return std::move(session).error().in(file.string());
    return session;
}

Result<std::string> parse_fingerprint(const std::string& text, const std::string& option,
                                      const std::string& source) {
    constexpr std::size_t digits = 64;
    std::string hex;
    for (const char c : text)
        if (c != ':') hex += c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
    if (is_hex(hex, digits)) return hex;
    return bad_input("must be 64 hexadecimal digits, " + source, option);
}

Result<net::ClientOptions> client_options(const MillSession& session) {
    WEAVE_TRY(net::ClientOptions options, net::parse_origin(session.origin));
    if (options.tls) {
        options.tls->fingerprint = session.fingerprint;
        return options;
    }
    if (!session.fingerprint.empty())
        return Error{ErrorCode::usage, "goes with https://: plain HTTP shows no certificate",
                     "fingerprint"};
    if (is_this_machine(options.host)) return options;
    return Error{ErrorCode::refused,
                 "plain HTTP to another machine shows passwords to whoever listens; use https://",
                 session.origin};
}

}  // namespace weave::wire
