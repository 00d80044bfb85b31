/*  A platform of Tartarus for bench/tartarus_ring.pl, and an agent that walks,
programmed as users of Tartarus would. */

:- prolog_load_context(directory, Dir),
   atom_concat(Dir, '/../prolog', Library),
   asserta(user:file_search_path(library, Library)).
:- if(getenv('TARTARUS', _)).
:- getenv('TARTARUS', File),
   consult(File).
:- else.
:- use_module(library(tartarus)).
:- endif.

:- dynamic walker/3, left/2, began/2, next/1.

walker(guid, (Ip, _), main) :-
    retract(left(guid, N)),
    (   N =:= 0
    ->  began(guid, T0),
        get_time(T),
        Seconds is T-T0,
        writeln(home(Seconds))
    ;   N1 is N-1,
        assertz(left(guid, N1)),
        next(Port),
        move_agent(guid, (Ip, Port))
    ).

up(Port, Next) :-
    assertz(next(Next)),
    start_tartarus(localhost, Port, 1),
    writeln(up).

%   send(+Name, +Hops): the agent starts here, and reports its time here.

send(Name, Hops) :-
    get_tartarus_details(Ip, Port),
    get_time(Now),
    create_mobile_agent(Name, (Ip, Port), walker, [1]),
    assertz(left(Name, Hops)),
    assertz(began(Name, Now)),
    add_payload(Name, [(left, 2), (began, 2)]),
    execute_agent(Name, (Ip, Port), walker).
