#pragma once

#include <weave/net/router.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// A file of loomlink/web as it was when the program was built.
struct PageFile {
    std::string_view path;  ///< below `web`, such as `parts/dom.js`
    std::string_view text;
};

/// All files of the page. Made by CMake.
std::span<const PageFile> page_files();

/// The routes that serve the page: its files, and its index for every other path of up to
/// `deepest_page_path` segments outside /api, since the page knows by itself what its paths show.
std::vector<net::Route> page_routes();

inline constexpr std::size_t deepest_page_path = 8;

}  // namespace weave::loomlink
