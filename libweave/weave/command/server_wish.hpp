#pragma once

#include <weave/wire/place.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace weave {

/// The server (simd) that a command speaks with, and as whom.
struct ServerWish {
    std::string host;         ///< as it was written; empty: none
    std::string token_file;   ///< without it the variable WEAVE_TOKEN of the environment
    std::string fingerprint;  ///< SHA-256 of the server's certificate
    std::string authorities;  ///< PEM file of those that may sign the server's certificate
};

/// Adds --on, --token-file, --fingerprint and --authorities; `wish` must outlive the command. Gives --on.
CLI::Option* add_server_options(CLI::App* command, ServerWish& wish);

/// The place of the server. Errors name the option.
Result<wire::ServerPlace> place_of(const ServerWish& wish);

}  // namespace weave
