:- module(typhon_thread_state,
          [ program_base/1,             % -Module
            is_confined/1,               % +Head
            machine_inside/0,
            step_ended/1,               % +Context
            library_hook/0
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2, memberchk/2, select/3]).
:- use_module(bodies, [control_of_system/1]).

/** <module> What an agent may change in its thread and process

Many agents share a process, and a thread runs one agent after the other.  The
modules of programs inherit from one module, which defines the predicates that
change the thread or the process before those of `system`.  A program may define
predicates of these names itself; code of libraries and of the place does not
inherit from that module.

  - Global variables are the agent's: while it runs they are variables of the
    thread with other names, and at each stop facts of its state.
  - What else an agent changes in its thread is restored when it stops.
  - Predicates that would break the process or its other agents raise errors.

A step is one call of machine_run/3.  In other threads, which the agent may have
created, all these predicates are those of `system`.

*Threading*: in the thread that runs the agent.
*/

:- multifile user:exception/3.
:- dynamic user:exception/3.

                /*******************************
                *           THE TABLE          *
                *******************************/

%   refused(?Head, -Advice): Head raises an error.

refused(Head, Advice) :-
    refused_all(Advice, PIs),
    member(Name/Arity, PIs),
    functor(Head, Name, Arity).

refused_all('it would change all agents of the process',
            [ format_predicate/2, char_conversion/2, system_mode/1,
              redefine_system_predicate/1, on_signal/3, on_signal/4,
              prolog_alert_signal/2, set_prolog_gc_thread/1,
              set_prolog_IO/3, thread_setconcurrency/2, chdir/1, cd/0, cd/1,
              protocol/1, protocola/1, noprotocol/0, at_halt/1,
              cancel_halt/1 ]).
refused_all('the debugger stops all agents of the process; \c
             agent_spy/2 and agent_step/1 stop one',
            [ trace/0, trace/1, trace/2, debug/0, nodebug/0, spy/1, nospy/1,
              nospyall/0, leash/1, visible/1, break/0, prolog/0, gtrace/0,
              gspy/1, gdebug/0, guitracer/0, tspy/1, tspy/2, tdebug/0,
              tdebug/1, tnodebug/0, tnodebug/1, set_breakpoint/4,
              set_breakpoint/5, delete_breakpoint/1, prolog_skip_level/2,
              prolog_skip_frame/1, attach_console/0 ]).
refused_all('it would end a thread of the platform; dispose/0 ends the agent',
            [ abort/0, thread_exit/1, fork/1, exec/1, detach_IO/0,
              detach_IO/1 ]).

%   refused_now(+Head, -Advice): some calls of Head are.

refused_now(working_directory(_, New), 'use absolute file names') :-
    nonvar(New).
refused_now(umask(_, New), 'it would change all agents of the process') :-
    nonvar(New).
refused_now(setlocale(_, _, New), 'use set_locale/1') :-
    nonvar(New).
refused_now(thread_detach(Thread), 'the platform joins this thread') :-
    thread_self(Thread).
refused_now(set_stream(Stream, _), 'all agents of the process write to it') :-
    member(Alias, [user_input, user_output, user_error]),
    stream_property(Standard, alias(Alias)),
    memberchk(Stream, [Alias,Standard]).
refused_now(set_stream(_, Property), 'use set_output/1') :-
    nonvar(Property),
    Property = alias(Alias),
    memberchk(Alias, [user_input, user_output, user_error]).

%   noted(?Head, ?Part): Head changes Part of the thread.

noted(set_output(_), output).
noted(set_input(_), input).
noted(tell(_), told).
noted(append(_), told).
noted(told, output).
noted(see(_), seen).
noted(seen, input).
noted(set_prolog_flag(Flag, _), flag(Flag)).
noted(style_check(_), style).
noted(prompt(_, _), prompt).
noted(set_random(_), random).
noted(set_locale(_), locale).
noted(set_prolog_stack(Stack, Property), stack(Stack, Name)) :-
    ( compound(Property) -> functor(Property, Name, 1) ; true ).
noted(mutex_lock(Mutex), mutex(Mutex)).
noted(mutex_trylock(Mutex), mutex(Mutex)).

%   variable(?Head, -Name, -Key, -Goal): Head is Goal of the variable Name, which
%   is named Key in the thread.

variable(nb_setval(Name, V), Name, Key, nb_setval(Key, V)).
variable(b_setval(Name, V), Name, Key, b_setval(Key, V)).
variable(nb_linkval(Name, V), Name, Key, nb_linkval(Key, V)).
variable(nb_getval(Name, V), Name, Key, value(Name, Key, V)).
variable(b_getval(Name, V), Name, Key, value(Name, Key, V)).
variable(nb_delete(Name), Name, Key, nb_delete(Key)).

confined(Head) :- control_of_system(Head).
confined(nb_current(_, _)).
confined(Head) :- variable(Head, _, _, _).
confined(Head) :- noted(Head, _).
confined(Head) :- refused(Head, _).
confined(working_directory(_, _)).
confined(umask(_, _)).
confined(setlocale(_, _, _)).
confined(thread_detach(_)).
confined(set_stream(_, _)).

%!  program_base(-Module) is det.
%
%   Modules of programs inherit from Module.

program_base('typhon program').

%!  is_confined(+Head) is semidet.

is_confined(Head) :-
    program_base(Base),
    '$get_predicate_attribute'(Base:Head, defined, 1),
    \+ '$get_predicate_attribute'(Base:Head, imported, _).

confine(Base, Name/Arity) :-
    functor(Head, Name, Arity),
    redefine_system_predicate(Base:Head),
    module_transparent(Base:Name/Arity),
    assertz(Base:(Head :-
                      context_module(Agent),
                      typhon_thread_state:call_confined(Head, Agent))),
    compile_predicates([Base:Name/Arity]).

:- initialization(( program_base(Base),
                    set_module(Base:base(system)),
                    forall(setof(Name/Arity,
                                 Head^( confined(Head),
                                        functor(Head, Name, Arity) ),
                                 PIs),
                           forall(member(PI, PIs), confine(Base, PI))) )).

                /*******************************
                *             CALLS            *
                *******************************/

:- public call_confined/2.

call_confined(Head, _), control_of_system(Head) =>
    functor(Head, Name, Arity),
    refuse(control_predicate, Name/Arity, 'call it where the agent can stop').
call_confined(Head, Agent), in_step =>
    in_step(Head, Agent).
call_confined(Head, Agent) =>
    system_call(Head, Agent).

in_step(Head, _), refused(Head, Advice) =>
    functor(Head, Name, Arity),
    refuse(process_predicate, Name/Arity, Advice).
in_step(Head, _), refused_now(Head, Advice) =>
    functor(Head, Name, Arity),
    refuse(process_predicate, Name/Arity, Advice).
in_step(nb_current(Name, Value), Agent) =>
    note(variables, Agent),
    (   var(Name)
    ->  nb_current(Key, Value),
        key(Name, Key)
    ;   key(Name, Key),
        nb_current(Key, Value)
    ).
in_step(Head, Agent), variable(Head, Name, Key, Goal) =>
    must_be(atom, Name),
    note(variables, Agent),
    key(Name, Key),
    call(Goal).
in_step(set_prolog_flag(Flag0, Value), Agent) =>
    ( subsumes_term(_:_, Flag0) -> Flag = Flag0 ; Flag = Agent:Flag0 ),
    note(flag(Flag), Agent),
    set_prolog_flag(Flag, Value).       % else some change module user
in_step(Head, Agent), noted(Head, Part) =>
    note(Part, Agent),
    system_call(Head, Agent).
in_step(Head, Agent) =>
    system_call(Head, Agent).

%   To check/0 this is no meta predicate: Head may not exist in this version.

system_call(Head, Agent) :-
    Goal = system:Head,
    @(Goal, Agent).

refuse(Type, PI, Advice) :-
    throw(error(permission_error(call, Type, PI), context(PI, Advice))).

%   key(?Name, ?Key): no name of the agent, since 9.0.4 keeps all keys for ever.

key(Name, Key) :-
    atom_concat('typhon_agent ', Name, Key).

value(Name, Key, Value) :-
    (   nb_current(Key, Value0)
    ->  Value = Value0
    ;   existence_error(variable, Name)
    ).

                /*******************************
                *             STEPS            *
                *******************************/

%   typhon_touched is a variable of the thread: a list of touched(Agent, Part,
%   Old), the last first.  It does not exist before the first call in a step.

in_step :-
    nb_current(typhon_touched, _),
    !.
in_step :-
    machine_inside,
    nb_setval(typhon_touched, []).

%!  machine_inside is semidet.
%
%   This thread is inside machine_run/3; for signals.

machine_inside :-
    prolog_current_frame(Frame),
    @(prolog_frame_attribute(Frame, parent_goal, first_outcome(_, _, _)),
      typhon_machine).

note(Part, Agent) :-
    nb_getval(typhon_touched, Touched),
    (   member(touched(Agent, Part0, _), Touched),
        Part0 == Part
    ->  true
    ;   ground(Part),
        old(Part, Agent, Old)
    ->  nb_getval(typhon_touched, Touched1),
        nb_setval(typhon_touched, [touched(Agent, Part, Old)|Touched1])
    ;   true                            % there is none, or the call raises
    ).

%   A library has no variable of this name in this thread, and makes it now, as
%   CHR does: from now on these variables are made anew after each step.

:- public library_makes/1.

library_makes(Name) :-
    \+ sub_atom(Name, 0, _, _, typhon_),
    in_step,
    machine_inside,
    note(variables, libraries),
    fail.

%!  library_hook is det.
%
%   Libraries may have been loaded: note the variables that they make, if one
%   does so when it asks for them.  While there is no such hook a variable that
%   does not exist costs less.

library_hook :-
    Hook = user:exception(undefined_global_variable, _, _),
    findall(Body, clause(Hook, Body), Bodies),
    (   member(typhon_thread_state:library_makes(_), Bodies)
    ->  true
    ;   Bodies == []
    ->  true
    ;   Hook = _:exception(_, Name, _),
        asserta((Hook :- typhon_thread_state:library_makes(Name)))
    ).

%!  step_ended(+Context) is det.
%
%   The step of an agent is over: restore the thread.

step_ended(_) :-
    nb_current(typhon_touched, []),
    !.
step_ended(context(_, Agent)) :-
    nb_current(typhon_touched, Touched),
    !,
    restore(Touched, Agent, Others),
    nb_setval(typhon_touched, Others).
step_ended(_) :-
    nb_setval(typhon_touched, []).

restore([], _, []).
restore([First|Touched], Agent, [First|Others]) :-
    First = touched(libraries, variables, Keys),
    !,
    restore(Touched, Agent, Others),
    library_variables_reset(Keys).
restore([touched(Agent, Part, Old)|Touched], Agent, Others) :-
    !,
    catch(ignore(restored(Part, Agent, Old)), error(_, _), true),
    restore(Touched, Agent, Others).
restore([First|Touched], Agent, [First|Others]) :-
    restore(Touched, Agent, Others).

%   old(+Part, +Agent, -Old) is semidet.
%   restored(+Part, +Agent, +Old) is semidet.

old(output, _, Out) :- current_output(Out).
old(input, _, In) :- current_input(In).
old(told, _, Out) :- current_output(Out).
old(seen, _, In) :- current_input(In).
old(flag(Flag), _, Old) :- current_prolog_flag(Flag, Old).
old(style, _, Old) :- '$style_check'(Old, Old).
old(prompt, _, Old) :- prompt(Old, Old).
old(random, _, Old) :-
    (   catch(random_property(state(State)), error(_, _), fail)
    ->  Old = state(State)
    ;   Old = seed(random)              % without GMP
    ).
old(locale, _, Old) :- current_locale(Old).
old(stack(Stack, Name), _, Old) :-
    functor(Old, Name, 1),
    prolog_stack_property(Stack, Old).
old(mutex(Mutex), _, Count) :- mutex_count(Mutex, Count).
old(variables, libraries, Keys) :-
    !,
    findall(Key, nb_current(Key, _), Keys).
old(variables, Agent, none) :-
    put_away,
    forall(catch(Agent:'$global'(Name, Value), error(_, _), fail),
           ( key(Name, Key), nb_setval(Key, Value) )).

%   In virtual time an agent may wait in the step of another one.

put_away :-
    nb_getval(typhon_touched, Touched0),
    select(touched(Other, variables, none), Touched0, Touched),
    !,
    restored(variables, Other, none),
    nb_setval(typhon_touched, Touched).
put_away.

restored(output, _, Out) :-
    set_output(Out).
restored(input, _, In) :-
    set_input(In).
restored(told, _, Out) :-
    current_output(Now),
    set_output(Out),
    ( Now == Out -> true ; close(Now, [force(true)]) ).
restored(seen, _, In) :-
    current_input(Now),
    (   Now == In
    ->  true
    ;   catch(seen, error(_, _), true)  % after see/1 close/2 ends 10.1
    ),
    set_input(In).
restored(flag(Flag), _, Old) :-
    set_prolog_flag(Flag, Old).
restored(style, _, Old) :-
    '$style_check'(_, Old).
restored(prompt, _, Old) :-
    prompt(_, Old).
restored(random, _, Old) :-
    set_random(Old).
restored(locale, _, Old) :-
    set_locale(Old).
restored(stack(Stack, _), _, Old) :-
    set_prolog_stack(Stack, Old).
restored(mutex(Mutex), _, Before) :-
    mutex_count(Mutex, Count),
    forall(( between(1, Count, N), N > Before ), mutex_unlock(Mutex)).
restored(variables, Agent, _) :-
    findall(Key-'$global'(Name, Value),
            ( nb_current(Key, Value), key(Name, Key) ),
            Pairs),
    retractall(Agent:'$global'(_, _)),
    forall(member(Key-Fact, Pairs),
           ( nb_delete(Key),
             ( is_storable(Fact) -> assertz(Agent:Fact) ; true ) )).

library_variables_reset(Keys) :-
    findall(Key,
            ( nb_current(Key, _),
              \+ memberchk(Key, Keys),
              \+ sub_atom(Key, 0, _, _, typhon_) ),
            Made),
    forall(member(Key, Made),
           (   user:exception(undefined_global_variable, Key, retry)
           ->  true
           ;   nb_delete(Key)           % 9.0.4 would not call the hook again
           )).

mutex_count(Mutex, Count) :-
    (   thread_self(Me),
        catch(mutex_property(Mutex, status(locked(Me, Count0))), error(_, _),
              fail)
    ->  Count = Count0
    ;   Count = 0
    ).

is_storable(Term) :-
    acyclic_term(Term),
    term_attvars(Term, []).
