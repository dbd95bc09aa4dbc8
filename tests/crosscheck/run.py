#!/usr/bin/env python3
"""run.py - compares the daemon's readers and writers with those of other programs.

    run.py --hedged PROGRAM --peers PROGRAM [--corpus DIR] [--files N] [--only obj,off] [--keep DIR]
    run.py --hedged PROGRAM --blender PROGRAM

readers.py compares the daemon with the reference reader of the corpus, if the corpus lies beside
the project; peers.py with assimp, OpenMesh and CGAL; meaning.py compares the values of corners with
assimp. With --blender, only blender.py runs, which compares with Blender. The last line is `N
passed, M failed`.
"""
import argparse
import os
import sys
import tempfile

import blender
import meaning
import peers
import readers
from daemon import Daemon


def run_blender(a):
    tally = peers.Tally()
    with Daemon(a.hedged) as daemon, tempfile.TemporaryDirectory() as folder:
        blender.run(daemon, a.blender, folder, tally)
    tally.failed += daemon.status != 0
    print('%d passed, %d failed' % (tally.passed, tally.failed))
    sys.exit(tally.failed > 0)


def main():
    p = argparse.ArgumentParser()
    p.add_argument('--hedged', required=True)
    p.add_argument('--peers')
    p.add_argument('--blender')
    p.add_argument('--corpus', default='../shared/corpus')
    p.add_argument('--files', type=int, default=6000)
    p.add_argument('--only', default=','.join(readers.MAKERS))
    p.add_argument('--keep', default='')
    p.add_argument('--show', type=int, default=2, help='examples of each difference')
    a = p.parse_args()
    if a.blender:
        run_blender(a)
    reference = None
    if os.path.isdir(os.path.join(a.corpus, 'tools')):
        sys.path.insert(0, os.path.join(a.corpus, 'tools'))
        import meshref as reference
    passed = failed = 0
    with Daemon(a.hedged) as daemon, tempfile.TemporaryDirectory() as folder:
        if reference is not None:
            passed, failed = readers.run(daemon, reference, os.path.join(a.corpus, 'files'), a.files,
                                         a.only.split(','), a.keep, a.show)
        else:
            print('note: there is no corpus, and so no reference reader')
        p, f = peers.run(daemon, reference, a.peers, folder)
        passed, failed = passed + p, failed + f
        tally = peers.Tally()
        meaning.run(daemon, folder, tally)
        print('note: corners in files of the daemon and of assimp: %d agree, %d do not' %
              (tally.passed, tally.failed))
        passed, failed = passed + tally.passed, failed + tally.failed
    failed += daemon.status != 0
    print('%d passed, %d failed' % (passed, failed))
    sys.exit(failed > 0)


if __name__ == '__main__':
    main()
