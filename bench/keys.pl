:- use_module(common).
:- use_module(traveller).
:- use_module('../app/keys', [keys_init/1, keys_issue/4]).
:- use_module(library(typhon)).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(lists), [max_list/2, member/2]).

/*  Hops between two processes with keys, and without.

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
    findall(Plain-Secure,
            ( between(1, 4, _),
              hops('', Plain),
              hops(Keys, Secure) ),
            Pairs),
    forall(member(Agents, [1, 100]), compared(Agents, Pairs)).

compared(Agents, Pairs) :-
    findall(R, ( member(Rs-_, Pairs), memberchk(Agents-R, Rs) ), Plains),
    findall(R, ( member(_-Rs, Pairs), memberchk(Agents-R, Rs) ), Secures),
    max_list(Plains, Plain),
    max_list(Secures, Secure),
    PlainHop is 1.0e6/Plain,
    SecureHop is 1.0e6/Secure,
    format(atom(Name), '~w agents: a hop over TLS against a plain one',
           [Agents]),
    ratio(Name, SecureHop, PlainHop, us, plain).

hops(Keys, Rates) :-
    setenv('TYPHON_TLS', Keys),
    host_start(here),
    with_peer([env], hops_to(Rates)),
    host_stop(here).

hops_to([1-One, 100-Many], Peer) :-
    travelled(1, 2000, Peer, _),        % warm up
    travelled(1, 8000, Peer, rates(One, _)),
    travelled(100, 20000, Peer, rates(Many, _)).
