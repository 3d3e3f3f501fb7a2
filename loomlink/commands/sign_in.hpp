#pragma once

#include <loomlink/commands/api_client.hpp>
#include <string>

namespace weave::loomlink {

/// The server that is meant, without anybody signed in: `origin`, or the one of the session before. The
/// certificate is that of `fingerprint`, if given, else that of the session before where it is the same
/// server. Errors: usage where no server is named; bad_input for what is no fingerprint.
Result<KeptSession> server_wished(const std::string& origin, const std::string& fingerprint,
                                  const KeptSession& before = {});

/// Signs in; the client goes on as this person. Gives the server's answer. The password is wiped.
Result<Json> sign_in(ApiClient& client, const std::string& name, std::string password);

/// The client goes on as the person of an answer to signing in or joining.
Status continue_as_told(ApiClient& client, const Json& answer, const std::string& name);

}  // namespace weave::loomlink
