// Checks the log's proofs in the browser itself (RFC 9162, 2.1.3.2 and 2.1.4.2), so that the server need not be believed.

const bytes = hex => Uint8Array.from(hex.match(/../g) ?? [], pair => parseInt(pair, 16));
const hex = buffer => [...new Uint8Array(buffer)].map(byte => byte.toString(16).padStart(2, '0')).join('');
const digest = async parts => hex(await crypto.subtle.digest('SHA-256', new Uint8Array(parts.flatMap(part => [...part]))));
export const leaf_hash = record => digest([[0], new TextEncoder().encode(record)]);
const node_hash = (left, right) => digest([[1], bytes(left), bytes(right)]);

export async function inclusion_holds(leaf, index, tree_size, path, root) {
    if (!(index < tree_size)) return false;
    let fn = BigInt(index), sn = BigInt(tree_size) - 1n, r = leaf;
    for (const p of path) {
        if (sn === 0n) return false;
        if ((fn & 1n) === 1n || fn === sn) {
            r = await node_hash(p, r);
            if ((fn & 1n) === 0n) while (fn !== 0n && (fn & 1n) === 0n) { fn >>= 1n; sn >>= 1n; }
        } else r = await node_hash(r, p);
        fn >>= 1n;
        sn >>= 1n;
    }
    return sn === 0n && r === root;
}

export async function consistency_holds(first, second, first_root, second_root, path) {
    if (first === second) return path.length === 0 && first_root === second_root;
    if (first === 0 || first > second || path.length === 0) return false;
    let fn = BigInt(first) - 1n, sn = BigInt(second) - 1n;
    const way = (BigInt(first) & (BigInt(first) - 1n)) === 0n ? [first_root, ...path] : [...path];
    while ((fn & 1n) === 1n) { fn >>= 1n; sn >>= 1n; }
    let fr = way[0], sr = way[0];
    for (const c of way.slice(1)) {
        if (sn === 0n) return false;
        if ((fn & 1n) === 1n || fn === sn) {
            fr = await node_hash(c, fr);
            sr = await node_hash(c, sr);
            if ((fn & 1n) === 0n) while (fn !== 0n && (fn & 1n) === 0n) { fn >>= 1n; sn >>= 1n; }
        } else sr = await node_hash(sr, c);
        fn >>= 1n;
        sn >>= 1n;
    }
    return sn === 0n && fr === first_root && sr === second_root;
}
