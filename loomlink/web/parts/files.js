// Files that somebody chose: their texts go to the server, and what is wrong with them is told with their names.
import { size } from './dom.js';

/** What can be chosen, and how large it may be: as large as the server takes it. */
export const kinds = {
    design: { what: 'design', most: 32 * 2 ** 20 },
    profile: { what: 'profile of a loom', most: 1 * 2 ** 20 },
    evidence: { what: 'evidence', most: 8 * 2 ** 20 },
};

/** The text of a file, given to `send`, and what that answers. Nothing is sent of a file that is too large, or no text. */
export async function send_file(file, { what, most }, send) {
    const about = text => new Error(`${file.name}: ${text}`);
    if (file.size > most) throw about(`has ${size(file.size)}, and a ${what} has ${size(most)} at most`);
    let text;
    try {
        text = new TextDecoder('utf-8', { fatal: true }).decode(await file.arrayBuffer());
    } catch {
        throw about(`is no ${what}, which is a text`);
    }
    try {
        return await send(text);
    } catch (error) {
        throw error.is_about_input === false ? error : about(error.told ?? error.message);
    }
}
