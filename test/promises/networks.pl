%   What doc/networks.md promises, see ../promises.pl.

promise(ring_closes, topology,
        'prolog/typhon/network/topology.pl',
        "    N > 2.\nlinked(star"-"    N > 3.\nlinked(star").
