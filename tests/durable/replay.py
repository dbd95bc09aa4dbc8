"""replay.py - what a store must hold: the changes that were answered, replayed in their order.

A daemon with a store in memory replays them. A change that was in flight (sent and not answered)
when the other daemon ended may be there or not. If a revision is missing between those that were
answered, or follows them, one of these changes must have made it. Everything that a client can see
is compared: elements with their ids and links, attributes, counters, the history with its tallies
and its length, and where undo and redo lead.
"""
import itertools
import json
import re

from daemon import Daemon
from writers import Change

MOST_TRIES = 200
LARGE = 5000  # a mesh with more vertices is compared by octets
RINGS = {'queries': [{'relation': 'outgoing', 'of': {'vertices': 'all'}}]}
OCTETS = {'Accept': 'application/octet-stream'}
TIMES = re.compile(rb'"(created|modified|time)":"[^"]*",?')
BYTES = re.compile(rb'"(memory_)?bytes":\d+,?')  # counts reserved memory, too, so it may differ
INCARNATION = re.compile(r'"[0-9a-f]+-')


class Wrong(Exception):
    """Raised if the store does not hold what was acknowledged; the text says what differs."""


def plain(body):
    """Returns an answer without the members in which two daemons may differ."""
    return BYTES.sub(b'', TIMES.sub(b'', body))


def state(client, mesh):
    """Returns everything that can be seen of a mesh, by the name of the view; None if there is no
    mesh."""
    base = f'/v1/meshes/{mesh}'
    summary = client.get(base)
    if summary.status == 404:
        return None
    if summary.status != 200:
        raise Wrong(f'{mesh}: {summary.status} {summary.body[:300]!r}')
    views = {'tag': INCARNATION.sub('', summary.headers['ETag']),
             'summary': plain(summary.body)}
    if summary.json()['counts']['vertices'] > LARGE:
        views['rings'] = client.send('POST', base + '/query', RINGS, OCTETS).body
        views['ply'] = client.get(base + '/content?format=ply').body
    else:
        for kind in ('vertices', 'halfedges', 'faces'):
            views[kind] = client.get(f'{base}/{kind}', 'application/x-ndjson').body
    views['materials'] = client.get(base + '/materials').body
    attributes = client.get(base + '/attributes')
    views['attributes'] = attributes.body
    for item in attributes.json()['attributes']:
        path = f'/attributes/{item["domain"]}/{item["name"]}'
        views[path] = client.get(base + path, 'application/octet-stream').body
    views['history'] = history(client, base)
    return views


def history(client, base):
    """Returns what can be undone, redone and read: [undo, redo, oldest, entries after that]."""
    told = client.get(base + '/edits?limit=1000').json()
    for entry in told['entries']:
        del entry['time'], entry['bytes']
    return json.dumps([told[name] for name in ('undo', 'redo', 'oldest')]
                      + [e for e in told['entries'] if e['revision'] > told['oldest']])


def as_far_as_both(ours, theirs):
    """Returns two histories, limited to the revisions that both have: a store on a disk reads back
    what memory has dropped."""
    ours, theirs = json.loads(ours), json.loads(theirs)
    oldest = max(ours[2], theirs[2])
    return [json.dumps(told[:2] + [e for e in told[3:] if e['revision'] > oldest])
            for told in (ours, theirs)]


def difference(ours, theirs):
    """Returns the first view that differs, in words; None if all are equal."""
    if ours is None or theirs is None:
        return None if ours is theirs else \
            f'the store {"lacks the mesh" if ours is None else "has a mesh that was deleted"}'
    for name in [*theirs, *ours]:
        a, b = ours.get(name), theirs.get(name)
        if name == 'history' and a is not None and b is not None:
            a, b = as_far_as_both(a, b)
        if a != b:
            at = next((i for i, (x, y) in enumerate(zip(a or '', b or '')) if x != y),
                      min(len(a or ''), len(b or '')))
            return (f'{name} differs at {at}: the store has ...{(a or "")[max(0, at - 60):at + 80]!r},'
                    f' the replay ...{(b or "")[max(0, at - 60):at + 80]!r}')
    return None


def is_valid(client, mesh):
    check = client.get(f'/v1/meshes/{mesh}/check').json()
    if not check['valid']:
        raise Wrong(f'{mesh}: {check["problems"][:3]}')


class Known:
    """What is known of a mesh: its incarnation, and the changes that led to the state of the
    replay."""

    def __init__(self):
        self.incarnation, self.changes = None, []


class Replay:
    def __init__(self, program, flags):
        self.daemon = Daemon(program, ['--store', 'memory', *flags])
        self.client = self.daemon.client()
        self.known = {}
        self.applied = self.in_flight = 0

    def close(self):
        self.client.close()
        return self.daemon.stop()

    # --- making changes again ---

    def make(self, change, version):
        """Replays a change; returns false if it does not lead to the revision that it led to
        before."""
        headers = {k: v for k, v in change.headers.items() if k != 'Prefer'}
        answer = self.client.send(change.method, f'/v1/meshes/{change.mesh}{change.path}',
                                  change.body, {**headers, 'Prefer': 'wait=600'})
        self.applied += 1
        return answer.status in (200, 201, 204) and answer.version()[1:] == version

    def forget(self, mesh):
        self.client.send('DELETE', f'/v1/meshes/{mesh}')

    def make_all(self, mesh, changes, fresh):
        """Replays changes; returns false if one of them fails."""
        if fresh:
            self.forget(mesh)
        names, revision = (0, 0) if fresh else self.position(mesh)
        for change in changes:
            creates = revision == 0
            names += 1 if creates else change.names
            revision += 1 if creates else change.revisions
            if not self.make(change, (names, revision)):
                return False
        return True

    def make_from(self, mesh, done, flying, version, theirs):
        """Makes a mesh from these changes alone, so that it is what the store has: `version` and
        the state `theirs`, or None. Raises Wrong."""
        known = self.known[mesh] = Known()
        if theirs is None:
            return
        known.incarnation, names, revision = version
        self.fit(mesh, (0, 0), done, flying, (names, revision), theirs, True)

    def position(self, mesh):
        names = revision = 0
        for change in self.known[mesh].changes:
            names += 1 if revision == 0 else change.names
            revision += 1 if revision == 0 else change.revisions
        return names, revision

    # --- comparing ---

    def follow(self, client, mesh, done, flying):
        """Compares a mesh of the store, which answers through `client`, with what was acknowledged
        of it. Afterwards the replay has the same mesh. Raises Wrong."""
        known = self.known.setdefault(mesh, Known())
        done = [c for c in done if c.mesh == mesh]
        flying = [c for c in flying if c.mesh == mesh]
        seen = client.get(f'/v1/meshes/{mesh}')
        if seen.status not in (200, 404):
            raise Wrong(f'{mesh}: {seen.status} {seen.body[:300]!r}')
        if seen.status == 404:
            self.expect_absent(mesh, known, done, flying)
            return
        incarnation, names, revision = seen.version()
        fresh = incarnation != known.incarnation
        if not fresh:
            self.expect_there(mesh, known, done)
        ours = sorted((c for c in done if not c.deletes() and c.version[0] == incarnation),
                      key=lambda c: (c.version[2], c.version[1]))
        self.expect_newest(mesh, incarnation, done, flying, fresh)
        place = (0, 0) if fresh else self.position(mesh)
        theirs = state(client, mesh)
        self.fit(mesh, place, ours, flying, (names, revision), theirs, fresh)
        known.incarnation = incarnation
        is_valid(client, mesh)

    def expect_absent(self, mesh, known, done, flying):
        """Handles a mesh that the store lacks: raises Wrong if it was made, and no deletion
        explains that it is missing."""
        made = [c for c in done if not c.deletes()]
        if (known.incarnation or made) and not any(c.deletes() for c in done + flying):
            raise Wrong(f'{mesh}: the store lacks the mesh, which nobody deleted')
        deleted = max((c.sent if c in flying else c.answered
                       for c in done + flying if c.deletes()), default=0)
        if not any(c.deletes() for c in flying):
            # A creation that was sent after the last deletion was answered must have left a mesh.
            for change in made:
                if change.sent > deleted:
                    raise Wrong(f'{mesh}: {change!r} was acknowledged after the last deletion')
        self.forget(mesh)
        self.known[mesh] = Known()

    def expect_there(self, mesh, known, done):
        """Handles a mesh that the store has: raises Wrong if a deletion was acknowledged that was
        sent after the mesh was seen."""
        for change in done:
            if change.deletes():
                others = [c.version[0] for c in done if not c.deletes()
                          and c.sent > change.answered]
                raise Wrong(f'{mesh}: {known.incarnation} was deleted, and is there; '
                            f'afterwards there was {others[:1]}')

    def expect_newest(self, mesh, incarnation, done, flying, fresh):
        """The incarnation must be the last one that was answered, or of a creation in flight."""
        made = [c for c in done if not c.deletes()]
        known = {c.version[0] for c in made}
        if incarnation in known:
            since = min(c.answered for c in made if c.version[0] == incarnation)
            for change in done:
                if change.deletes() and change.sent > since:
                    raise Wrong(f'{mesh}: it was deleted, and is there')
            for change in made:
                if change.version[0] != incarnation and change.sent > max(
                        c.answered for c in made if c.version[0] == incarnation):
                    raise Wrong(f'{mesh}: {change!r} was acknowledged of a newer one')
        elif fresh and not any(c.creates() for c in flying):
            raise Wrong(f'{mesh}: an incarnation that nobody asked for')

    def fit(self, mesh, place, ours, flying, end, theirs, fresh):
        """Finds which changes in flight were made, so that the replay comes to the same state."""
        known = self.known[mesh]
        gaps, steps = [], []  # a step is a change, or a gap of so many names and revisions
        names, revision = place
        for change in ours:
            start = (change.version[1] - change.names, change.version[2] - change.revisions)
            if change.version[2] == 1 and revision == 0:
                start = (0, 0)
            self.add_gap(mesh, gaps, steps, (names, revision), start, change)
            steps.append(change)
            names, revision = change.version[1:]
        self.add_gap(mesh, gaps, steps, (names, revision), end, None)
        base = [] if fresh else known.changes
        why = None
        for tries, filled in enumerate(self.fillings(gaps, flying)):
            if tries >= MOST_TRIES:
                break
            changes = []
            for step in steps:
                changes += filled[step] if isinstance(step, int) else [step]
            again = fresh or tries > 0
            made = self.make_all(mesh, base + changes if again else changes, again)
            why = difference(theirs, state(self.client, mesh)) if made else \
                'a change leads elsewhere when it is made again'
            if made and why is None:
                known.changes = base + changes
                self.in_flight += sum(len(f) for f in filled)
                return
        raise Wrong(f'{mesh}: {why or "no change in flight explains what is there"}; '
                    f'{len(ours)} acknowledged, gaps {gaps}, in flight {flying}')

    def add_gap(self, mesh, gaps, steps, place, start, change):
        names, revisions = start[0] - place[0], start[1] - place[1]
        if names < 0 or revisions < 0:
            raise Wrong(f'{mesh}: what was acknowledged is not there: {change or "the end"} begins at '
                        f'{start}, after {steps[-1:]} led to {place}')
        if names > 0 or revisions > 0:
            steps.append(len(gaps))
            gaps.append((names, revisions, place == (0, 0)))

    def fillings(self, gaps, flying):
        """Yields all ways to fill the gaps with changes in flight, none of them twice."""
        if not gaps:
            yield []
            return
        (names, revisions, creates), rest = gaps[0], gaps[1:]
        candidates = [c for c in flying if not c.deletes()]
        for count in range(1, len(candidates) + 1):
            for chosen in itertools.permutations(candidates, count):
                total = [sum(c.names for c in chosen), sum(c.revisions for c in chosen)]
                if creates and chosen[0].creates():
                    total = [total[0] - chosen[0].names + 1, total[1]]
                elif creates:
                    continue
                if total == [names, revisions]:
                    for others in self.fillings(rest, [c for c in flying if c not in chosen]):
                        yield [list(chosen), *others]

    # --- undo and redo lead where they would have led ---

    def walk(self, client, mesh):
        """Undoes and redoes everything on both sides; the mesh must be the same before and after,
        except for its revisions, which both sides must count alike."""
        if mesh not in self.known or self.known[mesh].incarnation is None:
            return 0
        history = json.loads(client.get(f'/v1/meshes/{mesh}/edits?limit=1').body)
        undo, redo = history['undo'], history['redo']
        for path, steps in (('/undo', undo), ('/redo', undo + redo), ('/undo', redo)):
            if steps == 0:
                continue
            answers = [c.send('POST', f'/v1/meshes/{mesh}{path}', {'steps': steps})
                       for c in (client, self.client)]
            if [a.status for a in answers] != [200, 200]:
                raise Wrong(f'{mesh}: {path} of {steps}: {[a.body[:200] for a in answers]}')
            why = difference(state(client, mesh), state(self.client, mesh))
            if why:
                raise Wrong(f'{mesh}: after {path} of {steps}: {why}')
            self.known[mesh].changes.append(
                Change(mesh, 'POST', path, {'steps': steps}, revisions=steps))
        return undo + redo
