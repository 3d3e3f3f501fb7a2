#include <studio/jobs/server_place.hpp>

#include <weave/core/file.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <cstdlib>
#include <utility>

namespace weave::studio {

namespace {

constexpr std::uint64_t most_file_bytes = 65'536;

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

Status take_token(wire::ServerPlace& place, std::string file) {
    if (file.empty()) file = variable("WEAVE_TOKEN_FILE");
    if (!file.empty()) {
        warn_if_not_private(file);
        WEAVE_TRY(std::string bytes, read_file(file, most_file_bytes));
        Status used = wire::use_token(place, bytes);
        wipe(bytes);
        if (!used) return std::move(used).error().in(file);
        return {};
    }
    const std::string token = variable("WEAVE_TOKEN");
    if (token.empty()) return {};  // the server says whether it needs one
    Status used = wire::use_token(place, token);
    if (!used) return std::move(used).error().in("WEAVE_TOKEN");
    return {};
}

}  // namespace

Result<wire::ServerPlace> place_of(const ServerWish& wish) {
    WEAVE_TRY(wire::ServerPlace place, wire::place_of(wish.host));
    if (!wish.fingerprint.empty()) {
        if (!place.options.tls)
            return Error{ErrorCode::usage,
                         "a certificate's fingerprint is of TLS, which this place is not reached by",
                         wish.host};
        place.options.tls->fingerprint = wish.fingerprint;
    }
    WEAVE_CHECK_OK(take_token(place, wish.token_file));
    return place;
}

}  // namespace weave::studio
