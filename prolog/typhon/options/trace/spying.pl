:- module(typhon_spying,
          [ spied_program/1,            % +Hash
            spied/3,                    % +Hash, +Goal, -Action
            trace_program/2             % +Spec, +Ports
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(prolog_trace), [trace/2]).
:- use_module('../../kernel/base/names', [names_proposed/3]).
:- use_module('../../kernel/program',
              [clause_parts/3, code_compiled/2, code_known/2, code_program/2]).

/** <module> Spy points on programs, by the names of programs

spy(census:tour/0), nospy/1 and trace/1,2 work for predicates of programs as for
those of modules.  census is the name of a program if no module of that name
defines tour/0.  The spy point also applies to programs that are loaded later.
Its effect depends on the kind of the predicate:

  - Agents are held at a spied goal, as by agent_step/1: a thread of an agent
    cannot read from the terminal.
  - Calls of predicates that the machine unfolds are printed as for a traced
    agent; other calls by Prolog's own trace/2, with all their ports.

*Threading*: any thread; agents read the table when a turn begins, and then at
each goal.
*/

:- multifile
    prolog:debug_control_hook/1,
    typhon_code:installed/2,
    typhon_on_demand:joins/2.

typhon_on_demand:joins(spied, program).

:- dynamic
    spied/4,                    % Program, Name, Arity, `hold` or `print`
    native/4.                   % Program, Name, Arity, Ports: traced by Prolog

%!  spied_program(+Hash) is semidet.
%!  spied(+Hash, +Goal, -Action) is semidet.
%
%   The program Hash has a spied predicate; Goal calls such a predicate, and
%   Action is `hold` or `print`.

spied_program(Hash) :-
    spied(_, _, _, _),
    !,
    code_program(Hash, program(Program, _, _, _)),
    spied(Program, _, _, _),
    !.

spied(Hash, Goal, Action) :-
    spied(_, _, _, _),
    callable(Goal),
    functor(Goal, Name, Arity),
    code_program(Hash, program(Program, _, _, _)),
    member(Action, [hold, print]),
    spied(Program, Name, Arity, Action),
    (   Action == hold
    ;   code_known(Hash, Kinds),
        memberchk(Name/Arity-Kind, Kinds),
        Kind \== native
    ),
    !.

                /*******************************
                *           SPY POINTS         *
                *******************************/

prolog:debug_control_hook(spy(Spec)) :-
    of_program(Spec, Program, Name, Arity),
    unspy(Program, Name, Arity, hold),
    assertz(spied(Program, Name, Arity, hold)),
    print_message(informational, typhon(spy(Program, Name, Arity))),
    forall(meant(Program, Name/Arity, Text),
           print_message(warning,
                         typhon(spied_none(Program, Name/Arity, Text)))).
prolog:debug_control_hook(nospy(Spec)) :-
    program_predicate(Spec, Program, Name, Arity),
    spied(Program, Name, Arity, hold),
    !,
    unspy(Program, Name, Arity, hold),
    print_message(informational, typhon(nospy(Program, Name, Arity))).
prolog:debug_control_hook(nospyall) :-
    retractall(spied(_, _, _, hold)),
    fail.

prolog:debug_control_hook(debugging) :-
    spied(Program, Name, Arity, hold),
    print_message(informational, typhon(spy(Program, Name, Arity))),
    fail.                               % Prolog prints its own

unspy(Program, Name, Arity, Action) :-
    retractall(spied(Program, Name, Arity, Action)).

%   meant(+Program, +PI, -Text) is semidet: this process has a program with the
%   name Program that does not define PI; Text proposes predicates that it does
%   define.

meant(Program, PI, Text) :-
    findall(Own, own(Program, Own), PIs0),
    sort(PIs0, PIs),
    \+ memberchk(PI, PIs),
    PI = Name/_,
    names_proposed(Name, PIs, Text),
    Text \== ''.

own(Program, PI) :-
    code_program(_, program(Program, State, _, Clauses)),
    (   member(PI, State)
    ;   member(Clause, Clauses),
        clause_parts(Clause, Head, _),
        functor(Head, Name, Arity),
        PI = Name/Arity
    ).

%   of_program(+Spec, -Program, -Name, -Arity): the arity may be left out.

of_program(Spec, Program, Name, Arity) :-
    program_predicate(Spec, Program, Name, Arity),
    \+ in_module(Program, Name, Arity).

program_predicate(Spec, Program, Name, Arity) :-
    strip_module(Spec, Program, Plain),
    atom(Program),
    \+ memberchk(Program, [user, system]),
    predicate(Plain, Name, Arity).

predicate(Name/Arity, Name, Arity) :-
    atom(Name).
predicate(Name//N, Name, Arity) :-
    atom(Name),
    integer(N),
    Arity is N+2.
predicate(Name, Name, _) :-
    atom(Name).

in_module(Module, Name, Arity) :-
    current_predicate(Module:Name/Arity),
    !.
in_module(Module, _, _) :-
    module_property(Module, file(_)),
    \+ program_module(Module, _).

program_module(Program, Module) :-
    code_program(Hash, program(Program, _, _, _)),
    code_compiled(Hash, Module).

%!  trace_program(+Spec, +Ports) is semidet.
%
%   As trace/2, for predicates of programs; fails for others.

trace_program(Spec, Ports) :-
    of_program(Spec, Program, Name, Arity),
    unspy(Program, Name, Arity, print),
    retractall(native(Program, Name, Arity, _)),
    (   asked(Ports)
    ->  assertz(spied(Program, Name, Arity, print)),
        assertz(native(Program, Name, Arity, Ports))
    ;   true
    ),
    forall(program_module(Program, Module),
           trace_native(Module, Name, Arity, Ports)).

asked(Ports) :-
    \+ is_list(Ports),
    !,
    Ports \= -_.
asked(Ports) :-
    member(Port, Ports),
    asked(Port),
    !.

trace_native(Module, Name, Arity, Ports) :-
    forall(( current_predicate(Module:Name/Arity),
             functor(Head, Name, Arity),
             \+ unfolded(Module, Head) ),
           trace(Module:Name/Arity, Ports)).

typhon_code:installed(Program, Module) :-
    native(Program, Name, Arity, Ports),
    trace_native(Module, Name, Arity, Ports).

unfolded(Module, Goal) :-
    Module:'$mobile'(Goal, _, _, _, _, _),
    !.
