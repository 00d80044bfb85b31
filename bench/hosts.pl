:- use_module(common).
:- use_module(library(typhon)).

/*  A thousand hosts in one process. */

:- initialization(main, main).

main([_]) :-
    host_start(first),
    resident_bytes(B0),
    seconds(forall(between(1, 1000, I),
                   ( atom_concat(h, I, Name), host_start(Name) )),
            Seconds),
    resident_bytes(B1),
    figure('1,000 hosts started', Seconds, s),
    MB is (B1-B0)/1.0e6,
    figure('1,000 hosts', MB, 'MB'),
    seconds(forall(between(1, 1000, I),
                   ( atom_concat(h, I, Name), host_stop(Name) )),
            Stop),
    figure('1,000 hosts stopped', Stop, s),
    host_stop(first).
