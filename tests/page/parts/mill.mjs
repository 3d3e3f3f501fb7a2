// A mill of its own for each run: the real server on an empty folder and a free port, and designs made by the real program.
import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { createHash, X509Certificate } from 'node:crypto';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

export const tree = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../../..');
const programs = process.env.WEAVE_BIN ?? path.join(tree, 'build/release/bin');

/** Runs a program; an error tells what it said. */
const run = (program, ...words) => promisify(execFile)(path.join(programs, program), words);
const weave = (...words) => run('weave', ...words);

/** Two revisions of a cloth of 1,824 picks: rows of toddler shoes, and the same with one crossing exchanged; and a plain weave. */
async function make_designs(folder) {
    const [shoe, shoes, better, plain] = ['shoe', 'shoes', 'better', 'plain'].map(name => path.join(folder, name + '.weave'));
    await weave('samples', 'plain', '-o', plain);
    await weave('samples', 'shoe-toddler', '-o', shoe);
    await weave('tile', shoe, '--x', '3', '--y', '4', '-o', shoes);
    await weave('flip', shoes, '--pick', '1234', '--end', '100', '-o', better);
    return { shoes, better, plain };
}

async function first_line(program) {
    for await (const line of createInterface({ input: program.stdout })) return line;
    throw new Error('the server ended before it said where it serves');
}

/** A machine of the mill, enrolled with its code, knows the mill by its key of access and simulates a design. Answers the file of what it signed. */
async function simulate(folder, code, access, { url, certificate_sha256 }, design) {
    const box = path.join(folder, 'box'), config = path.join(folder, 'box.json'), evidence = path.join(folder, 'signed.evidence');
    await run('loomlink', 'signer', 'enrol', code, '--server', new URL(url).origin, '--fingerprint', certificate_sha256, '--key-file', path.join(folder, 'box.key'));
    await writeFile(config, JSON.stringify({ site: access.site, access_keys: [access.public], evidence_key: 'box.key', address: '' }));
    const simd = spawn(path.join(programs, 'simd'), ['serve', box, '--config', config, '--json'], { stdio: ['ignore', 'pipe', 'inherit'] });
    const ended = new Promise(resolve => simd.on('close', resolve));
    try {
        await first_line(simd);
        await weave('simulate', design, '-o', path.join(folder, 'there.yarns'), '--on', 'unix:' + path.join(box, 'simd.sock'), '--evidence', evidence);
    } finally {
        simd.kill('SIGTERM');
        await ended;
    }
    return evidence;
}

/** What a browser has to know of a key to take its self-made certificate, and no other. */
export async function pin_of(certificate) {
    const { publicKey } = new X509Certificate(await readFile(certificate));
    return createHash('sha256').update(publicKey.export({ type: 'spki', format: 'der' })).digest('base64');
}

/** Starts everything. Answers {origin, invitation, pin, designs, simulate(code, access), profile, stop()}. */
export async function open_mill() {
    const folder = await mkdtemp(path.join(tmpdir(), 'page-stories-'));
    const site = path.join(folder, 'site');
    const server = spawn(path.join(programs, 'loomlink'), ['serve', site, '--port', '0', '--host', 'localhost', '--json'], { stdio: ['ignore', 'pipe', 'pipe'] });
    let told = '';
    server.stderr.on('data', bytes => { told += bytes; });
    const ended = new Promise(resolve => { server.on('close', (code, signal) => resolve(signal ?? code)); server.on('error', resolve); });
    const stop = async () => {
        server.kill('SIGTERM');
        const end = await ended;
        await rm(folder, { recursive: true, force: true });
        assert.equal(end, 0, `the server did not end in good order: ${end}\n${told}`);
    };
    try {
        const introduction = JSON.parse(await first_line(server));
        const { url, invitation } = introduction, designs = await make_designs(folder);
        return {
            origin: new URL(url).origin, invitation, stop, pin: await pin_of(path.join(site, 'tls.pem')),
            designs, simulate: (code, access) => simulate(folder, code, access, introduction, designs.plain), profile: path.join(tree, 'db/looms/ep-2688.json'), told: () => told,
        };
    } catch (error) {
        server.kill('SIGKILL');
        await rm(folder, { recursive: true, force: true });
        throw new Error(`${error.message}\n${told}`);
    }
}
