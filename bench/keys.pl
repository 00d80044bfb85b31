:- use_module(common).
:- use_module(traveller).
:- use_module('../app/keys', [keys_init/1, keys_issue/4]).
:- use_module(library(typhon)).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(lists), [max_list/2, member/2]).

/*  Hops between two processes with keys, with keys and trail, and without.

    swipl bench/keys.pl

By turns; the best of each counts, as what disturbs only makes them slower. */

:- initialization(main, main).

main :-
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
    forall(( member(How, [tls, trail]), member(Agents, [1, 100]) ),
           compared(How, Agents, All)).

compared(How, Agents, All) :-
    best(plain, Agents, All, Plain),
    best(How, Agents, All, Other),
    format(atom(Name), '~w agents: a hop with ~w against a plain one',
           [Agents, How]),
    ratio(Name, Other, Plain, us, plain).

best(How, Agents, All, Microseconds) :-
    findall(Rate, ( member(How-Rates, All), memberchk(Agents-Rate, Rates) ),
            Some),
    max_list(Some, Best),
    Microseconds is 1.0e6/Best.

hops(Keys, Trail, Hops, Rates) :-
    setenv('TYPHON_TLS', Keys),
    host_start(here, [trail(Trail)]),
    with_peer([env], hops_to(Trail, Hops, Rates)),
    host_stop(here).

hops_to(Trail, Hops, [1-One, 100-Many], Peer) :-
    host_change(Peer, trail(Trail)),
    travelled(1, 200, Peer, _),         % warm up
    travelled(1, Hops, Peer, rates(One, _)),
    travelled(100, Hops, Peer, rates(Many, _)).
