#include <weave/picture/picture.hpp>

#include <weave/picture/views.hpp>

#include <charconv>
#include <new>
#include <utility>

namespace weave {

namespace {

/// Views without a number.
constexpr std::pair<std::string_view, View> plain_views[]{{"card", View::card},     {"face", View::face},
                                                          {"back", View::back},     {"floats", View::floats},
                                                          {"layers", View::layers}, {"block", View::block}};

/// The row (or column) of the pick (or end) that people call `text`.
Result<std::size_t> line_of(std::string_view text, const Block& block, System system) {
    const bool weft = system == System::weft;
    const std::size_t count = weft ? block.picks() : block.ends();
    std::size_t number = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (code != std::errc{} || end != text.data() + text.size() || number < 1 || number > count) {
        return Error{ErrorCode::usage,
                     std::string("a ") + (weft ? "weft" : "warp") + " slice needs the number of " +
                         (weft ? "a pick" : "an end") + " from 1 to " + std::to_string(count) + ", not '" +
                         std::string(text.substr(0, 40)) + "'",
                     {}};
    }
    return weft ? block.row_of_pick(number - 1) : block.column_of_end(number - 1);
}

}  // namespace

Result<std::string> draw_view(const Subject& subject) {
    switch (subject.request.view) {
        case View::card:
            return draw_card(subject);
        case View::face:
        case View::back:
            return draw_surface(subject);
        case View::floats:
            return draw_floats(subject);
        case View::layers:
            return draw_layers(subject);
        case View::weft_slice:
        case View::warp_slice:
            return draw_slice(subject);
        case View::block:
            return draw_block(subject);
    }
    return invalid("there is no such view");
}

Result<PictureRequest> parse_view(std::string_view text, const Block& block) {
    PictureRequest request;
    for (const auto& [name, view] : plain_views) {
        if (text != name) continue;
        request.view = view;
        return request;
    }
    for (const bool weft : {true, false}) {
        const std::string_view start = weft ? "weft:" : "warp:";
        if (!text.starts_with(start)) continue;
        request.view = weft ? View::weft_slice : View::warp_slice;
        WEAVE_TRY(request.line,
                  line_of(text.substr(start.size()), block, weft ? System::weft : System::warp));
        return request;
    }
    return Error{ErrorCode::usage,
                 "there is no view '" + std::string(text.substr(0, 40)) +
                     "': choose card, face, back, floats, layers, weft:N, warp:N or block, or 3d of a .yarns file",
                 {}};
}

Status show_span(PictureRequest& request, const Block& block, const PictureSpan& span) {
    const auto refused = [](std::string message) { return Error{ErrorCode::usage, std::move(message), {}}; };
    using Number = std::optional<std::size_t>;
    const auto check = [&](Number from, Number to, std::size_t count, View slice, const std::string& yarn,
                           const std::string& views) -> Status {
        if ((from || to) && request.view != slice && request.view != View::block)
            return refused("only " + views + " can begin or end at a chosen " + yarn);
        for (const Number number : {from, to}) {
            if (number && (*number < 1 || *number > count))
                return refused("there is no such " + yarn + " as " + std::to_string(*number) + ": the cloth has 1 to " +
                               std::to_string(count));
        }
        if (from && to && *to < *from)
            return refused("a picture from " + yarn + " " + std::to_string(*from) + " cannot end at " + yarn + " " + std::to_string(*to));
        return {};
    };
    WEAVE_CHECK_OK(check(span.from_pick, span.to_pick, block.picks(), View::warp_slice, "pick", "warp slices and the block"));
    WEAVE_CHECK_OK(check(span.from_end, span.to_end, block.ends(), View::weft_slice, "end", "weft slices and the block"));
    if (span.from_pick) request.first_row = block.row_of_pick(*span.from_pick - 1);
    if (span.to_pick) request.last_row = block.row_of_pick(*span.to_pick - 1);
    if (span.from_end) request.first_column = block.column_of_end(*span.from_end - 1);
    if (span.to_end) request.last_column = block.column_of_end(*span.to_end - 1);
    return {};
}

Result<std::string> draw(const Design& design, const Evaluation& cloth, const PictureRequest& request,
                         PictureFormat format) {
    if (!cloth.block) return invalid("there is no cloth to draw");
    const Block& block = *cloth.block;
    if ((request.view == View::weft_slice && request.line >= block.rows()) ||
        (request.view == View::warp_slice && request.line >= block.columns())) {
        return Error{ErrorCode::usage,
                     "the cloth has " + std::to_string(block.rows()) + " rows and " +
                         std::to_string(block.columns()) + " columns of stacks, so there is no slice " +
                         std::to_string(request.line + 1),
                     {}};
    }
    if (request.first_row >= block.rows() || request.first_column >= block.columns()) {
        return Error{ErrorCode::usage,
                     "the cloth has " + std::to_string(block.rows()) + " rows and " +
                         std::to_string(block.columns()) +
                         " columns of stacks, so a picture cannot begin at row " +
                         std::to_string(request.first_row + 1) + ", column " +
                         std::to_string(request.first_column + 1),
                     {}};
    }
    if (request.last_row < request.first_row || request.last_column < request.first_column)
        return Error{ErrorCode::usage, "a picture cannot end before it begins", {}};
    try {
        return draw_view({design, block, request, format});
    } catch (const std::bad_alloc&) {
        return system_fault("there is not enough memory to draw this cloth");
    }
}

}  // namespace weave
