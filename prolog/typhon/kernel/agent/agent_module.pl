:- module(typhon_agent_module,
          [ agent_module/5,             % +Id, +Place, +Hash, +State, -Module
            agent_module/4,             % +Id, +Place, +Program, +Clauses
            agent_program/3,            % +Place, +Hash, -Program
            agent_code/2,               % +Module, -Program
            agent_build/5,              % +Id, +Place, +Hash, +Begin, -Agent
            agent_clauses/3,            % +Module, +Clauses0, -Clauses
            agent_add/2,                % +Clauses, +Module
            agent_state/2,              % +Module, -State
            agent_state_mobile/4,       % +Module, +Since, -Until, -Bound
            agent_links/4,              % +Module, +Place0, +Place, -Links
            agent_relink/2,             % +Module, +Links
            agent_handles/2,            % +Program, +Module
            agent_declare/2,            % +PIs, +Module
            agent_variant/2             % +Module, -Variant
          ]).
:- use_module(library(lists), [memberchk/2]).
:- use_module('../program', [code_known/2, code_module/2, plain_goals/2]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../host', [host/3, parts/3, parts_call/3, place_host/2]).
:- use_module(agents, [agent_here/5]).

/** <module> The module that holds the state of an agent

Each agent has a temporary module; its dynamic predicates are the state of the
agent.  The program of the agent is found through the import chain, see
typhon_code and typhon_place.

An option may rewrite the agents that come to a host, for example to check
their calls.  Such an agent does not import from the place of the host, but from
a view of it, a module that the option has made: the part of the host in the
phase `view`, see typhon_host_parts.  The option defines the hooks

    variant(View, Variant)      agents that import from View have this variant,
                                a term that the option chooses
    program(Variant, Hash, Module)  Module has the program of that hash
    state(Variant, State0, State)   an agent comes with State0
    goals(Variant, Program, Goals0, Goals)
                                an agent whose program is in the module Program
                                comes with Goals0
    clauses(Variant, Clauses0, Clauses)
                                clauses are added to the state of an agent
    declares(Variant, PI)       a payload defines PI
    called(Variant, Module, Closure, Extra, Goal)
                                the agent in Module calls Goal by
                                '$checked'(Closure, Extra, ...)

A hook raises an error to refuse.  An agent keeps its variant as long as it is
on the host, even if the options of the host change.

*Threading*: any thread; while an agent runs only its worker uses the module.
*/

%!  agent_module(+Id, +Place, +Hash, +State, -Module) is semidet.
%
%   Make a module with the state of an agent.  An error in the state is raised
%   here, and leaves no module behind.  Fails if no program has that Hash.
%
%   @arg State is state(Empty, Clauses): the indicators of the dynamic
%        predicates that have no clauses, and the clauses of the others.
%   @error those of assertz/1, and of the hooks of a variant

agent_module(Id, Place, Hash, State0, Module) :-
    agent_program(Place, Hash, Program),
    place_imports(Place, State0, Above, State),
    State = state(Empty, Clauses),
    free_module(Id, Module),
    module_create(Module, Program, Above),
    begins(Place, Module),
    catch(( agent_declare(Empty, Module),
            agent_add(Clauses, Module) ),
          error(Formal, Context),
          ( '$destroy_module'(Module),
            throw(error(Formal, Context)) )).

%!  agent_module(+Id, +Place, +Program, +Clauses) is det.
%
%   As agent_module/5, on a host without parts and where no module Id exists.
%   Program is the module of the program.

agent_module(Id, Place, Program, Clauses) :-
    module_create(Id, Program, Place),
    catch(agent_add(Clauses, Id), error(Formal, Context),
          ( '$destroy_module'(Id),
            throw(error(Formal, Context)) )).

module_create(Module, Program, Above) :-
    set_module(Module:class(temporary)),
    set_module(Module:base(Program)),
    add_import_module(Module, Above, end).

begins(Place, Module) :-
    (   parts(module, _, _),
        host(Host, _, Place)
    ->  parts_call(module, Host, [Module])
    ;   true
    ).

%!  agent_program(+Place, +Hash, -Program) is semidet.
%
%   Agents on Place import from the module Program, which is made now if it was
%   not.  The program of that Hash is compiled as it is only for places that run
%   it as it is.  Fails if there is none.
%
%   @error those of code_module/2, and of the hooks of a variant

agent_program(Place, Hash, Program) :-
    place_variant(Place, _, Variant),
    !,
    code_known(Hash, _),
    typhon_agent_module:program(Variant, Hash, Program).
agent_program(_, Hash, Program) :-
    code_module(Hash, Program).

%   place_imports(+Place, +State0, -Above, -State): an agent on Place also
%   imports from Above, and has State in place of State0.

place_imports(Place, State0, View, State) :-
    place_variant(Place, View, Variant),
    !,
    typhon_agent_module:state(Variant, State0, State).
place_imports(Place, State, Place, State).

%!  agent_code(+Module, -Program) is det.
%
%   Program is the module that has the agent's program on this host.

agent_code(Module, Program) :-
    import_module(Module, Program),
    !.

%   agent_goals(+Module, +Goals0, -Goals): Goals are Goals0 in the form that the
%   agent runs on this host.
%
%   @error those of the hooks of a variant

agent_goals(Module, Goals0, Goals) :-
    agent_variant(Module, Variant),
    !,
    agent_code(Module, Program),
    plain_goals(Goals0, Plain),
    typhon_agent_module:goals(Variant, Program, Plain, Goals).
agent_goals(_, Goals, Goals).

%!  agent_build(+Id, +Place, +Hash, +Begin, -Agent) is semidet.
%
%   As agent_module/5, for an agent that has goals: Begin is State-Goals0,
%   Agent is Module-Goals.

agent_build(Id, Place, Hash, State-Goals0, Module-Goals) :-
    agent_module(Id, Place, Hash, State, Module),
    catch(agent_goals(Module, Goals0, Goals), error(Formal, Context),
          ( '$destroy_module'(Module),
            throw(error(Formal, Context)) )).

%!  agent_clauses(+Module, +Clauses0, -Clauses) is det.
%
%   Clauses are Clauses0 in the form in which they are added to the state of the
%   agent.
%
%   @error those of the hooks of a variant

agent_clauses(Module, Clauses0, Clauses) :-
    (   agent_variant(Module, Variant)
    ->  typhon_agent_module:clauses(Variant, Clauses0, Clauses)
    ;   Clauses = Clauses0
    ).

%   The module Id may belong to a copy of the agent that waits for the end of
%   its hop.

free_module(Id, Module) :-
    (   agent_here(Id, _, Id, _, _)
    ->  atom_concat(Id, ' again', Module)
    ;   Module = Id
    ).

%!  agent_declare(+PIs, +Module) is det.
%
%   The state of the agent has the predicates PIs.

agent_declare([], _).
agent_declare([PI|PIs], Module) :-
    dynamic(Module:PI),
    agent_declare(PIs, Module).

%!  agent_add(+Clauses, +Module) is det.
%
%   Add Clauses, as in agent_clauses/3, to the state of the agent.
%
%   The predicate of a rule is declared dynamic first.  Otherwise the first rule
%   would be compiled like a static one, and clause/2 of 9.0.4 would not return
%   it as it was: a variable that is unified first and used later would be two
%   variables.

agent_add([], _).
agent_add([Clause|Clauses], Module) :-
    (   Clause = (Head :- _)
    ->  functor(Head, Name, Arity),
        dynamic(Module:Name/Arity)
    ;   true
    ),
    assertz(Module:Clause),
    agent_add(Clauses, Module).

%!  agent_state(+Module, -State) is det.
%
%   State is state(Empty, Clauses) of the agent in Module, see agent_module/5.

agent_state(Module, state(Empty, Clauses)) :-
    findall(Item, state_item(Module, Item), Items),
    (   memberchk((:- dynamic(_)), Items)
    ->  split(Items, Empty, Clauses)
    ;   Empty = [],                     % usually
        Clauses = Items
    ).

%   This calls internal predicates, because predicate_property/2 is ten times
%   slower.

state_item(Module, Item) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    (   clause(Module:Head, Body)
    *-> (   Body == true
        ->  Item = Head
        ;   Item = (Head:-Body)
        )
    ;   functor(Head, Name, Arity),
        Item = (:- dynamic(Name/Arity))
    ).

split([], [], []).
split([Item|Items], Empty, Clauses) :-
    (   Item = (:- dynamic(PI))
    ->  Empty = [PI|Empty1],
        split(Items, Empty1, Clauses)
    ;   Clauses = [Item|Clauses1],
        split(Items, Empty, Clauses1)
    ).

%!  agent_state_mobile(+Module, +Since:integer, -Until:integer, -Bound) is det.
%
%   The clauses of the predicates of the state that have changed since the
%   generation Since can travel; Until is the Since of the next call.  The first
%   call passes 0.  Bound is `free` if Module holds nothing but the state that
%   travels and links to its program and the vocabulary, which all places have;
%   else `bound`.
%
%   @error type_error(mobile_term, Culprit)

agent_state_mobile(Module, Since, Until, Bound) :-
    State = state(Since, free),
    (   '$c_current_predicate'(_, Module:Head),
        (   '$get_predicate_attribute'(Module:Head, imported, From)
        ->  \+ is_link(Module, Head, From),
            nb_setarg(2, State, bound)
        ;   '$get_predicate_attribute'(Module:Head, (dynamic), 1)
        ->  '$get_predicate_attribute'(Module:Head, last_modified_generation,
                                       Last),
            ( Last > Since ; Last =:= 0 ),  % few changed
            state_mobile(Module:Head, Last, State)
        ;   '$get_predicate_attribute'(Module:Head, defined, 1),
            nb_setarg(2, State, bound)
        ),
        fail
    ;   State = state(Until, Bound)
    ).

is_link(Module, Head, From) :-
    (   Base = typhon_vocabulary
    ;   agent_code(Module, Base)
    ),
    (   From == Base
    ;   '$get_predicate_attribute'(Base:Head, imported, From)
    ),
    !.

%   state_mobile(:Head, +Last, !State): State, state(Until, Bound), includes the
%   predicate of Head, which changed at Last.

state_mobile(Head, Last, State) :-
    '$get_predicate_attribute'(Head, number_of_clauses, Count),
    clauses_mobile(Count, Head),
    arg(1, State, Last0),
    Until is max(Last, Last0),
    nb_setarg(1, State, Until),
    '$get_predicate_attribute'(Head, (thread_local), 1),
    nb_setarg(2, State, bound).

%   Mostly one fact has changed: to check a few clauses one by one is quicker
%   than to collect them.

clauses_mobile(Count, Module:Head) :-
    (   Count > 4
    ->  findall(Head-Body, clause(Module:Head, Body), Clauses),
        mobile_term(Clauses)
    ;   \+ ( clause(Module:Head, Body),
             \+ mobile_term(Head-Body) )
    ).

%!  agent_links(+Module, +Place0, +Place, -Links) is semidet.
%
%   Links is Above0-Above: the modules from which the agent in Module imports on
%   Place0, and is to import on Place.  Fails if it runs another variant there.

agent_links(Module, Place0, Place, Above0-Above) :-
    (   typhon_agent_module:variant(_, _)
    ->  same_variant(Place0, Place, Module, Above0, Above)
    ;   Above0 = Place0,
        Above = Place
    ).

%!  agent_relink(+Module, +Links) is det.
%
%   The agent in Module imports from Above in place of Above0.

agent_relink(Module, Above0-Above) :-
    delete_import_module(Module, Above0),
    add_import_module(Module, Above, end).

%   Both places run the same variant, or both the unchanged program.  9.0.4's
%   import_module/2 with a bound second argument tests only the first import
%   module.

same_variant(Place0, Place, Module, Above0, Above) :-
    place_above(Place0, Above0, Variant),
    place_above(Place, Above, Variant),
    once(( import_module(Module, Some), Some == Above0 )).

place_above(Place, View, Variant) :-
    place_variant(Place, View0, Variant0),
    !,
    View = View0,
    Variant = Variant0.
place_above(Place, Place, none).

%!  agent_handles(+Program, +Module) is semidet.
%
%   True if there is a handler for messages in the agent's program or state.

agent_handles(Program, Module) :-
    (   '$c_current_predicate'(_, Program:on_message(_,_))
    ->  true
    ;   predicate_property(Module:on_message(_,_), number_of_clauses(N)),
        N > 0
    ).

                /*******************************
                *           VARIANTS           *
                *******************************/

:- multifile
    variant/2,                  % View, Variant
    program/3,                  % Variant, Hash, Module
    state/3,                    % Variant, State0, State
    goals/4,                    % Variant, Program, Goals0, Goals
    clauses/3,                  % Variant, Clauses0, Clauses
    declares/2,                 % Variant, PI
    called/5.                   % Variant, Module, Closure, Extra, Goal

:- dynamic
    state/3,
    declares/2.

%   place_variant(+Place, -View, -Variant) is semidet.
%
%   View is the module from which agents that come to Place now import.  Fails
%   for places that run unchanged programs.

place_variant(Place, View, Variant) :-
    (   variant(_, _)
    ->  place_host(Place, Host),
        parts(view, Host, [View|_]),
        variant(View, Variant),
        !
    ).

%!  agent_variant(+Module, -Variant) is semidet.
%
%   The agent in Module runs a variant of its program.

agent_variant(Module, Variant) :-
    (   variant(_, _)
    ->  import_module(Module, View),
        variant(View, Variant),
        !
    ).
