#pragma once

#include <weave/core/result.hpp>
#include <weave/net/client.hpp>

#include <filesystem>
#include <string>

namespace weave::wire {

/// Which loomlink a person talks to and as whom, kept from one program to the next: its commands and the studio share it.
struct MillSession {
    std::string origin;       ///< `https://host:port`
    std::string fingerprint;  ///< SHA-256 of the server's certificate; empty: the system's authorities decide
    std::string name;         ///< of the person who signed in; empty: nobody has
    std::string token;        ///< shown with every call; empty: nobody is signed in
    std::string site;         ///< that an enrolled machine signs for; empty: none is enrolled here
};

/// Where a session lies if nobody says otherwise: `loomlink/session.json` below $XDG_CONFIG_HOME, or below
/// `.config` at home. Error (usage): there is neither.
Result<std::filesystem::path> usual_session_file();

/// A file below a folder of the user's own: `variable` names it, else `usual` below the home. Error (usage):
/// there is neither.
Result<std::filesystem::path> user_folder(const char* variable, const char* usual);

/// Makes the folders that are missing above a file, for the user alone.
Status make_folders_for(const std::filesystem::path& file);

/// Keeps a session in a file of mode 0600, whole or not at all; folders that are missing are made for the
/// user alone. Refused where others may read the file that is there.
Status save_session(const std::filesystem::path& file, const MillSession& session);

/// Reads what save_session() wrote; an empty session where there is no file: nobody has signed in. Error (refused) where
/// others may read it.
Result<MillSession> load_session(const std::filesystem::path& file);

/// A fingerprint as a person gives it: 64 hexadecimal digits, with or without colons. Lower case. Errors:
/// bad_input; it names the option, and says where people find the fingerprint, such as `as the server tells
/// them when it starts`.
Result<std::string> parse_fingerprint(const std::string& text, const std::string& option,
                                      const std::string& source);

/// How to reach the server of a session. Errors: bad_input for what is no origin; refused for plain HTTP to
/// another machine, where passwords could be read on the way; usage for a fingerprint beside plain HTTP.
Result<net::ClientOptions> client_options(const MillSession& session);

}  // namespace weave::wire
