#pragma once

namespace weave {

/// Whether this is compiled to be watched by the address or thread sanitizer, which takes some ten times the time and memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif
#else
inline constexpr bool is_sanitized = false;
#endif

/// Whether this is compiled to be watched at all, by those or by who counts the lines that run: it takes several times the time.
#if defined(WEAVE_COUNTS_LINES)
inline constexpr bool is_instrumented = true;
#else
inline constexpr bool is_instrumented = is_sanitized;
#endif

}  // namespace weave
