// Hears at once when the releases of a loom change, also after the line was down or the tablet slept.
import { at } from './api.js';

const first_wait = 1000, longest_wait = 30000;

/** Calls `on_change()` at each change, and after each time the line was down. Answers how to stop. */
export function watch_loom(loom, on_change) {
    let socket, again, wait = first_wait, was_down = false, stopped = false;
    const open = () => {
        socket = new WebSocket(`${location.origin.replace(/^http/, 'ws')}/api/v1${at('looms', loom, 'watch')}`);
        socket.onopen = () => {
            wait = first_wait;
            if (was_down) on_change();
            was_down = false;
        };
        socket.onmessage = () => on_change();
        socket.onclose = () => {
            if (stopped) return;
            was_down = true;
            again = setTimeout(open, wait);
            wait = Math.min(wait * 2, longest_wait);
        };
    };
    open();
    return () => {
        stopped = true;
        clearTimeout(again);
        socket.onmessage = null;
        socket.onopen = () => socket.close(); // one that is only being opened cannot be closed in silence
        if (socket.readyState === WebSocket.OPEN) socket.close();
    };
}
