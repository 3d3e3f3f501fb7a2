#include <weave/command/server_wish.hpp>

#include <weave/core/file.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <cstdlib>
#include <string_view>
#include <utility>

namespace weave {

namespace {

constexpr std::uint64_t most_file_bytes = 65'536;

CLI::Validator fingerprint() {
    return {[](std::string& word) {
                const bool fits = word.size() == 64 && word.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
                return fits ? std::string() : std::string("is the SHA-256 of the server's certificate: 64 hexadecimal digits");
            },
            ""};
}

/// The token of the file, or of the environment; where there is neither, the server says whether it needs one.
Status take_token(wire::ServerPlace& place, const ServerWish& wish) {
    const char* const given = std::getenv("WEAVE_TOKEN");
    if (wish.token_file.empty() && given == nullptr) return {};
    if (wish.token_file.empty()) {
        Status used = wire::use_token(place, given);
        if (!used) return std::move(used).error().in("WEAVE_TOKEN");
        return {};
    }
    warn_if_not_private(wish.token_file);
    WEAVE_TRY(std::string bytes, read_file(wish.token_file, most_file_bytes));
    Status used = wire::use_token(place, bytes);
    wipe(bytes);
    if (!used) return std::move(used).error().in(wish.token_file);
    return {};
}

}  // namespace

CLI::Option* add_server_options(CLI::App* command, ServerWish& wish) {
    CLI::Option* on = command->add_option("--on", wish.host, "the server (simd) that computes: box, box:8444, https://box:8444 or unix:PATH")
                          ->type_name("HOST");
    command->add_option("--token-file", wish.token_file, "the file with the token that loomlink gave (loomlink token), or simd (simd token add); without it WEAVE_TOKEN of the environment")
        ->needs(on)
        ->type_name("FILE");
    CLI::Option* pinned = command->add_option("--fingerprint", wish.fingerprint, "SHA-256 of the server's certificate, where no authority signed it")
                              ->needs(on)
                              ->check(fingerprint())
                              ->type_name("HEX");
    command->add_option("--authorities", wish.authorities, "certificates of those that may sign the server's, instead of the system's")
        ->needs(on)
        ->excludes(pinned)
        ->type_name("PEM");
    return on;
}

Result<wire::ServerPlace> place_of(const ServerWish& wish) {
    auto place = wire::place_of(wish.host);
    if (!place) return Error{ErrorCode::usage, std::move(place.error().message), "--on " + place.error().where};
    if (place->options.tls) {
        place->options.tls->fingerprint = wish.fingerprint;
        place->options.tls->authorities = wish.authorities;
    } else if (!wish.fingerprint.empty() || !wish.authorities.empty()) {
        return Error{ErrorCode::usage, "is of TLS, which this place is not reached by", wish.fingerprint.empty() ? "--authorities" : "--fingerprint"};
    }
    WEAVE_CHECK_OK(take_token(*place, wish));
    return place;
}

}  // namespace weave
