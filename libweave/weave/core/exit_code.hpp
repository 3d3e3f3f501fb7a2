#pragma once

#include <weave/core/json.hpp>

namespace weave {

/// The exit status with which every program answers an error: 1 findings (a refusal by validation among
/// them), 2 usage, 3 bad input, 4 refused, 5 a fault of the system. Scripts rely on it.
inline int exit_code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::usage:
            return 2;
        case ErrorCode::bad_input:
            return 3;
        case ErrorCode::invalid:
            return 1;
        case ErrorCode::refused:
            return 4;
        case ErrorCode::system:
            break;
    }
    return 5;
}

/// What a program that reads along is told of an error: `kind`, `where`, `message`, `exit`.
inline Json error_json(const Error& error) {
    return {{"kind", kind_of(error.code)},
            {"where", error.where},
            {"message", error.message},
            {"exit", exit_code_of(error.code)}};
}

}  // namespace weave
