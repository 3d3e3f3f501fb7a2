#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <string>

namespace weave::simd {

/// An error as daemon and worker, and the daemon's files, write it: `kind`, `where`, `message`.
inline Json to_json(const Error& error) {
    return {{"kind", kind_of(error.code)}, {"where", error.where}, {"message", error.message}};
}

/// Throws where it is none.
inline Error error_from(const Json& json) {
    Error error{ErrorCode::system, json.at("message"), json.at("where")};
    for (const ErrorCode code : {ErrorCode::usage, ErrorCode::bad_input, ErrorCode::invalid, ErrorCode::refused}) {
        if (json.at("kind") == kind_of(code)) error.code = code;
    }
    return error;
}

}  // namespace weave::simd
