#include <weave/design/yarns.hpp>

#include <charconv>

namespace weave {

namespace {

/// Reads a number at the start of `text` and takes it off.
bool take_number(std::string_view& text, std::uint32_t& number) {
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (code != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

}  // namespace

Result<Sequence> parse_sequence(std::string_view text, std::uint32_t below) {
    Sequence sequence{{}};
    std::size_t at = 0;
    while ((at = text.find_first_not_of(' ', at)) != std::string_view::npos) {
        const std::string_view word = text.substr(at, text.find(' ', at) - at);
        at += word.size();
        std::string_view rest = word;
        std::uint32_t number = 0, count = 1;
        bool fine = take_number(rest, number);
        if (fine && !rest.empty()) {
            fine = rest.front() == '*';
            rest.remove_prefix(1);
            fine = fine && take_number(rest, count) && rest.empty() && count > 0;
        }
        if (!fine)
            return bad_input("'" + std::string(word.substr(0, 40)) +
                             "' is neither a number nor a run such as 0*12");
        if (number >= below) {
            return bad_input("names number " + std::to_string(number) + ", but there are only " +
                             std::to_string(below) + ", counted from 0");
        }
        if (count > longest_sequence - sequence.once.size()) {
            return bad_input("is longer than " + std::to_string(longest_sequence) + " elements");
        }
        sequence.once.insert(sequence.once.end(), count, number);
    }
    if (sequence.once.empty()) return bad_input("is empty, but needs at least one number");
    return sequence;
}

std::string to_text(const Sequence& sequence) {
    std::string text;
    for (std::size_t i = 0; i < sequence.once.size();) {
        std::size_t next = i + 1;
        while (next < sequence.once.size() && sequence.once[next] == sequence.once[i]) ++next;
        if (!text.empty()) text.push_back(' ');
        text += std::to_string(sequence.once[i]);
        if (next - i > 1) text += "*" + std::to_string(next - i);
        i = next;
    }
    return text;
}

WarpPlan default_warp() {
    WarpPlan warp;
    warp.yarns = {{"warp cotton", {0xd9, 0x8a, 0x2b}, 0.15, 50, 100, 0.01, 1}};
    warp.beams = {{"beam 1"}};
    return warp;
}

WeftPlan default_weft() {
    WeftPlan weft;
    weft.yarns = {{"weft cotton", {0x8c, 0x8c, 0x8c}, 0.15, 50, 100, 0.01, 1}};
    weft.feeders = {{"shuttle 1", 0}};
    return weft;
}

}  // namespace weave
