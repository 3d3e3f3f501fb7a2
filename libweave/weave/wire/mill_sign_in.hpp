#pragma once

#include <weave/wire/mill_client.hpp>
#include <string>

namespace weave::wire {

/// The server that is meant, without anybody signed in: `origin`, or the one of the session before. The
/// certificate is that of `fingerprint`, if given, else that of the session before where it is the same
/// server. Errors: usage where no server is named; bad_input for what is no fingerprint, at `option`.
Result<MillSession> server_wished(const std::string& origin, const std::string& fingerprint,
                                  const MillSession& before = {}, const std::string& option = "--fingerprint");

/// Signs in; the client goes on as this person. Gives the server's answer. The password is wiped.
Result<Json> sign_in(MillClient& client, const std::string& name, std::string password);

/// The client goes on as the person of an answer to signing in or joining.
Status continue_as_told(MillClient& client, const Json& answer, const std::string& name);

}  // namespace weave::wire
