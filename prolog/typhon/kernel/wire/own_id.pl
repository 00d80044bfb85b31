:- module(typhon_own_id,
          [ own_place/4,                % +Interface0, +Port0, -Interface, -Port
            own_start/1,                % -Start
            own_start_next/1,           % -Start
            own_id_note/1,              % +Address
            endpoint_process/1          % -Id
          ]).
:- use_module('../../options/journal', [journal_item/5, journal_opened/1, note_put/4]).
:- use_module(auth, [random_hex/2]).

/** <module> Who this process is

Its id, and how often it has begun to listen, tell peers whether they meet who
they met before.

*Threading*: own_place/4 and own_start_next/1 are for who starts the endpoint,
under its mutex; the others any thread may call.
*/

:- dynamic
    process/1,                          % Id
    starts/1.                           % Count

%!  own_place(+Interface0, +Port0, -Interface, -Port) is det.
%
%   Where to listen. A process that has a journal is from now on who it was when
%   that was last open, and listens where it did.  Others know it by the first
%   letter of its id, see endpoint_lasting/1.

own_place(Interface0, Port0, Interface, Port) :-
    journal_opened(_),
    !,
    retractall(process(_)),
    (   journal_item(endpoint, any, _, _,
                     endpoint(Process, Start, Interface1, Port1))
    ->  retractall(starts(_)),
        assertz(starts(Start)),
        ( Port0 =:= 0 -> Port = Port1 ; Port = Port0 ),
        ( Interface0 == localhost -> Interface = Interface1
        ; Interface = Interface0 )
    ;   random_hex(8, New),
        atom_concat(j, New, Process),
        Port = Port0,
        Interface = Interface0
    ),
    assertz(process(Process)).
own_place(Interface, Port, Interface, Port) :-
    (   process(Process),
        sub_atom(Process, 0, _, _, j)
    ->  retractall(process(_))
    ;   true
    ).

%!  own_start(-Start) is semidet.
%!  own_start_next(-Start) is det.
%
%   How often this process has begun to listen.

own_start(Start) :-
    starts(Start),
    !.

own_start_next(Start) :-
    (   retract(starts(Start0))
    ->  true
    ;   Start0 = 0
    ),
    Start is Start0+1,
    assertz(starts(Start)).

%!  own_id_note(+Address) is det.
%
%   The journal knows it, and where it listens.

own_id_note(Address) :-
    atomic_list_concat([Interface, PortText], :, Address),
    atom_number(PortText, Port),
    endpoint_process(Process),
    starts(Start),
    note_put(endpoint, '', 0, endpoint(Process, Start, Interface, Port)).

%!  endpoint_process(-Id) is det.
%
%   The random id of this process.

endpoint_process(Id) :-
    process(Id0),
    !,
    Id = Id0.
endpoint_process(Id) :-
    random_hex(8, New),
    with_mutex(typhon_runtime,
               (   process(_)
               ->  true
               ;   assertz(process(New))
               )),
    endpoint_process(Id).
