:- module(typhon_contacts,
          [ contact_met/2,              % +Address, +Process
            contact_gone/1,             % +Address
            contact_missed/2,           % +Address, +Formal
            missed/2,                   % ?Address, ?Formal
            contact_expect/1,           % +Address
            contact_expect_no_more/1,   % +Address
            contact_expected/1,         % +Address
            contact/3                   % ?Address, ?Process, ?State
          ]).

/** <module> What is known of addresses

Which process was last met at an address, and whether it has left: nobody
listens there any more, or it said goodbye. A process that is silent, and
one behind a cut network, has not left. Where nobody could be met, what went
wrong the last time. A bounded number of addresses is
kept, the oldest are forgotten.

*Threading*: any thread; a mutex makes changes one at a time.
*/

:- use_module('../../options/journal', [note_drop/3, note_put/4]).
:- use_module(library(settings), [setting/2, setting/4]).

:- setting(contacts, positive_integer, 10000,
           "Addresses of which is known who was met there").

:- multifile typhon_durable:restore/4.

:- dynamic
    contact/3,                          % Address, Process, met or gone
    missed/2,                           % Address, Formal
    contact_expected/1.                 % Address

%!  contact(?Address, ?Process, ?State) is nondet.
%
%   Process was the last one met at Address, `none` if there never was one.
%   State is `met`, or `gone` if it has left.

%!  contact_met(+Address, +Process) is det.
%!  contact_gone(+Address) is det.
%
%   Process is at Address; nobody is there any more.

contact_met(Address, Process) :-
    with_mutex(typhon_contacts,
               ( note(Address, Process, met),
                 retractall(missed(Address, _)) )).

contact_gone(Address) :-
    with_mutex(typhon_contacts,
               ( last_met(Address, Process),
                 note(Address, Process, gone) )).

%!  contact_missed(+Address, +Formal) is det.
%!  missed(?Address, ?Formal) is nondet.
%
%   Nobody could be met at Address, because of the error Formal.

contact_missed(Address, Formal) :-
    with_mutex(typhon_contacts,
               ( retractall(missed(Address, _)),
                 assertz(missed(Address, Formal)),
                 forget_missed )).

forget_missed :-
    predicate_property(missed(_, _), number_of_clauses(Count)),
    setting(contacts, Max),
    (   Count > Max
    ->  once(retract(missed(_, _)))
    ;   true
    ).

%!  contact_expect(+Address) is det.
%!  contact_expect_no_more(+Address) is det.
%!  contact_expected(+Address) is semidet.
%
%   If nobody is at Address somebody soon will be: who owns the process there
%   starts it again.

contact_expect(Address) :-
    with_mutex(typhon_contacts,
               ( retractall(contact_expected(Address)),
                 assertz(contact_expected(Address)) )).

contact_expect_no_more(Address) :-
    with_mutex(typhon_contacts, retractall(contact_expected(Address))).

last_met(Address, Process) :-
    contact(Address, Process0, _),
    !,
    Process = Process0.
last_met(_, none).

note(Address, Process, State) :-
    contact(Address, Process, State),
    !.
note(Address, Process, State) :-
    findall(Old, clause(contact(Address, _, _), true, Old), Olds),
    assertz(contact(Address, Process, State)),
    forall(member(Old, Olds), erase(Old)),
    note_lasting(Process, Address),
    forget_oldest.

%   That somebody will be there again must not be forgotten.

note_lasting(Process, Address) :-
    sub_atom(Process, 0, _, _, j),
    !,
    note_put(lasting, Address, 0, Process).
note_lasting(none, _) :-
    !.
note_lasting(_, Address) :-
    note_drop(lasting, Address, 0).

typhon_durable:restore(lasting, Address, _, Process) :-
    assertz(contact(Address, Process, met)).

forget_oldest :-
    predicate_property(contact(_, _, _), number_of_clauses(Count)),
    setting(contacts, Max),
    Excess is Count-Max,
    forall(between(1, Excess, _),
           ignore(retract(contact(_, _, _)))).
