#include <weave/block/stack.hpp>

#include <charconv>

namespace weave {

Stack::Stack(std::vector<Slot> slots) : m_slots(std::move(slots)) {
    while (!m_slots.empty() && m_slots.back().is_empty()) m_slots.pop_back();
    for (const Slot slot : m_slots) {
        if (slot.is_weft()) ++m_wefts;
        if (slot.is_warp()) ++m_warps;
    }
}

bool Stack::weft_over(std::size_t weft, std::size_t warp) const {
    for (const Slot slot : m_slots) {
        if (slot.is_warp() && slot.index() == warp) return true;
        if (slot.is_weft() && slot.index() == weft) return false;
    }
    return false;
}

Status Stack::check(std::size_t first_pick, std::size_t first_end) const {
    std::vector<bool> seen_weft(m_wefts), seen_warp(m_warps);
    for (const Slot slot : m_slots) {
        if (slot.is_empty()) continue;
        const bool weft = slot.is_weft();
        std::vector<bool>& seen = weft ? seen_weft : seen_warp;
        const auto name = [&](std::size_t index) {
            return (weft ? "T" : "P") + std::to_string(index + (weft ? first_pick : first_end));
        };
        if (slot.index() >= seen.size()) {
            const std::string yarns = weft ? "pick" : "end";
            return bad_input("holds " + name(slot.index()) + ", but the " +
                             (seen.size() == 1 ? "only " + yarns + " of this stack is " + name(0)
                                               : yarns + "s of this stack are " + name(0) + " to " +
                                                     name(seen.size() - 1)));
        }
        if (seen[slot.index()]) return bad_input("holds " + name(slot.index()) + " twice");
        seen[slot.index()] = true;
    }
    return {};  // as many numbers as yarns, all below that count, none twice: so none is missing
}

std::vector<std::size_t> Stack::positions(System system) const {
    std::vector<std::size_t> places(system == System::weft ? m_wefts : m_warps);
    for (std::size_t k = 0; k < m_slots.size(); ++k) {
        const Slot slot = m_slots[k];
        if (system == System::weft ? slot.is_weft() : slot.is_warp()) places[slot.index()] = k;
    }
    return places;
}

std::size_t StackHash::operator()(const Stack& stack) const {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const Slot slot : stack.slots()) hash = (hash ^ slot.bits()) * 0x100000001b3;
    return hash ^ hash >> 32;
}

Result<Stack> parse_stack(std::string_view text, std::size_t first_pick, std::size_t first_end) {
    std::vector<Slot> slots;
    std::size_t at = 0;
    while (true) {
        at = text.find_first_not_of(" \t", at);
        if (at == std::string_view::npos) return Stack(std::move(slots));
        const std::string_view word = text.substr(at, text.find_first_of(" \t", at) - at);
        at += word.size();
        if (word == "-" || word == "E") {
            slots.emplace_back();
            continue;
        }
        const bool loose = word.back() == '~';
        const std::string_view digits = word.substr(1, word.size() - 1 - (loose ? 1 : 0));
        std::uint32_t number = 0;
        const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        const bool yarn = word[0] == 'T' || word[0] == 'P';
        if (!yarn || digits.empty() || code != std::errc{} || end != digits.data() + digits.size() ||
            number >= Slot::most_yarns) {
            return bad_input("'" + std::string(word.substr(0, 40)) +
                             "' is not a yarn such as T0, P12 or P3~, nor - for empty");
        }
        const std::size_t first = word[0] == 'T' ? first_pick : first_end;
        if (number < first) {
            return bad_input("holds " + std::string(word) + ", which belongs to an earlier " +
                             (word[0] == 'T' ? "row" : "column"));
        }
        slots.push_back(word[0] == 'T' ? Slot::weft(number - first, loose)
                                       : Slot::warp(number - first, loose));
    }
}

std::string to_text(const Stack& stack, std::size_t first_pick, std::size_t first_end) {
    std::string text;
    for (const Slot slot : stack.slots()) {
        if (!text.empty()) text.push_back(' ');
        if (slot.is_empty()) {
            text.push_back('-');
            continue;
        }
        text += slot.is_weft() ? 'T' : 'P';
        text += std::to_string(slot.index() + (slot.is_weft() ? first_pick : first_end));
        if (slot.is_loose()) text.push_back('~');
    }
    return text;
}

}  // namespace weave
