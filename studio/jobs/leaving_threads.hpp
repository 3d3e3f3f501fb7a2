#pragma once

#include <functional>

namespace weave::studio {

/// Begins a thread that nobody has to wait for: who asked it to end may go on at once. What it uses must be
/// its own. At the end of the program the last of them get two seconds.
void run_apart(std::function<void()> work);

/// Gives the system back what was freed. The yarns of a cloth are many small pieces, and where each of them lay glibc would keep the room.
void return_freed_memory();

}  // namespace weave::studio
