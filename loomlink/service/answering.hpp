#pragma once

#include <functional>
#include <loomlink/service/table.hpp>
#include <loomlink/workflow/cloths.hpp>
#include <string>

namespace weave::loomlink {

/// A handler that answers JSON, or the error with its status.
ApiHandler answering(std::function<Result<Json>(const ApiCall&)> work);

/// Bytes of some media type, such as a picture.
struct Content {
    std::string media;
    std::string bytes;
    std::string file_name{};  ///< to be saved under; empty: to be shown
};

/// A handler that answers bytes with an entity tag. What can change is asked for each time.
ApiHandler giving(std::function<Result<Content>(const ApiCall&)> work);

/// The id and the password that a step brings.
Ask ask_of(const ApiCall& call);

/// The part of a card that a query asks for.
CardTile tile_of(const ApiCall& call);

/// `attachment; filename="…"` for any name: RFC 6266, with all but plain characters percent-encoded.
std::string disposition_of(const std::string& file_name);

}  // namespace weave::loomlink
