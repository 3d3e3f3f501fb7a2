#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <loomlink/keys/file_name.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t longest = 100;

Error refused(std::string_view name, const std::string& why) {
    return bad_input("the file name '" + on_one_line(name.substr(0, longest)) + "' " + why);
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-' || c == '_';
}

/// CON, PRN, AUX, NUL, COM0 to COM9, LPT0 to LPT9, with any ending.
bool is_device(std::string_view name) {
    const std::string stem = folded_name(name.substr(0, name.find('.')));
    constexpr std::array<std::string_view, 4> devices{"con", "prn", "aux", "nul"};
    if (std::find(devices.begin(), devices.end(), stem) != devices.end()) return true;
    return stem.size() == 4 && (stem.starts_with("com") || stem.starts_with("lpt")) && stem[3] >= '0' &&
           stem[3] <= '9';
}

}  // namespace

std::string folded_name(std::string_view name) {
    std::string folded(name);
    for (char& c : folded) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return folded;
}

Status check_file_name(std::string_view name) {
    if (name.empty()) return refused(name, "is empty");
    if (name.size() > longest)
        return refused(name, "has more than " + std::to_string(longest) + " characters");
    if (name.find_first_of("/\\") != std::string_view::npos)
        return refused(name, "leads into a folder; files of a release lie side by side");
    if (!std::all_of(name.begin(), name.end(), is_plain))
        return refused(name, "may have letters, digits, points, hyphens and underscores alone");
    if (name.front() == '.' || name.front() == '-')
        return refused(name, "may not start with a point or a hyphen");
    if (name.back() == '.') return refused(name, "may not end with a point");
    if (is_device(name)) return refused(name, "is the name of a device on Windows");
    return {};
}

}  // namespace weave::loomlink
