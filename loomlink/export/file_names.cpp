#include <algorithm>
#include <loomlink/export/controller_files.hpp>
#include <loomlink/export/file_parts.hpp>

namespace weave::loomlink {

bool is_printable(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

std::string without_filling(const std::string& text) {
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

Result<FittedName> fit_name(const std::string& wish, const LoomProfile& profile) {
    if (!is_printable(wish))
        return invalid("the name in the file for the loom may have letters, digits and signs of ASCII only");
    const std::string whole = without_filling(wish);
    const std::size_t room = profile.name_limit == 0 ? name_room : std::min(name_room, profile.name_limit);
    FittedName fitted{without_filling(whole.substr(0, room)), whole.size() > room};
    if (fitted.name.empty())
        return invalid("the file for the loom needs a name that starts with more than blanks");
    return fitted;
}

}  // namespace weave::loomlink
