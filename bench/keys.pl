:- use_module(common).
:- use_module(traveller).
:- use_module('../app/typhon/keys', [keys_init/1, keys_issue/4]).
:- use_module(library(typhon)).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(lists), [max_list/2, member/2]).

/*  Hops between two processes with keys, with keys and trail, and without.

    swipl bench/run.pl -- keys

Configurations alternate; the best result of each counts, since disturbances
only make hops slower. Both the time by the clock and the processor time are
printed. The single agent carries all trail links that are kept; each of a
hundred agents has up to eight. */

:- initialization(main, main).

main(_) :-
    tmp_file(keys, Dir),
    setup_call_cleanup(
        ( keys_init(Dir), keys_issue(host, here, 1, Dir) ),
        compare(Dir),
        delete_directory_and_contents(Dir)).

compare(Dir) :-
    atom_concat(Dir, '/here', Keys),
    findall(How-Rates,
            ( between(1, 4, _),
              member(How-Directory-Trail-Hops,
                     [ plain-''-false-8000, tls-Keys-false-8000,
                       trail-Keys-true-400 ]),
              hops(Directory, Trail, Hops, Rates) ),
            All),
    forall(( member(How, [tls, trail]), member(Agents, [1, 100]),
             member(Clock, [clock, processor]) ),
           compared(How, Agents, Clock, All)).

compared(How, Agents, Clock, All) :-
    best(plain, Agents, Clock, All, Plain),
    best(How, Agents, Clock, All, Other),
    format(atom(Name), '~w agents: a hop with ~w against a plain one, ~w',
           [Agents, How, Clock]),
    ratio(Name, Other, Plain, us, plain).

best(How, Agents, Clock, All, Microseconds) :-
    findall(Rate, ( member(How-Rates, All), memberchk(Agents-Both, Rates),
                    by(Clock, Both, Rate) ),
            Some),
    max_list(Some, Best),
    Microseconds is 1.0e6/Best.

by(clock, rates(Rate, _), Rate).
by(processor, rates(_, Rate), Rate).

hops(Keys, Trail, Hops, Rates) :-
    setenv('TYPHON_TLS', Keys),
    host_start(here, [trail(Trail)]),
    with_peer([env], hops_to(Trail, Hops, Rates)),
    host_stop(here).

hops_to(Trail, Hops, [1-One, 100-Many], Peer) :-
    host_change(Peer, trail(Trail)),
    travelled(1, 200, Peer, _),         % warm up
    travelled(1, Hops, Peer, One),
    travelled(100, Hops, Peer, Many).
