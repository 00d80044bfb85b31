:- module(typhon_agent_words,
          [ words_only/3,               % +Query, +Module, -PI
            word_told/3,                % +Spec, //
            directive_meant/2,          % +Directive, -Directives
            directive_coloured/2,       % +Directive, -Colours
            words_file/1                % ?File
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/program', [declaration/4, indicator_in/2]).
:- use_module('../kernel/vocabulary', []).

/** <module> What agents can say, for the top level and for editors

`move(beta)` is for the programs of agents.  Typed at the top level, or called
in a module, it is an error that names what is called there instead; the
correction of Prolog itself would offer the predicate of the module that
implements it.

Editors see a program through library(prolog_xref) and library(prolog_colour):
PceEmacs, Sweep for Emacs, the language server lsp_server.  These learn here
that in a file with `:- agent(Name, Options)` what agents can say is built in,
main/0 and on_message/2 are called, and which of its predicates are state; and
that a payload offers what it provides.  What is loaded is not concerned.

*Threading*: any thread; editors: see prolog_load_context/2.
*/

%!  words_only(+Query, +Module, -PI) is semidet.
%
%   A goal of Query calls PI, which is a word of agents and nothing else in
%   Module.

words_only(Query, Module, PI) :-
    goal(Query, Module, Goal),
    functor(Goal, Name, Arity),
    PI = Name/Arity,
    word(PI),
    \+ predicate_property(Module:Goal, visible),
    !.

%   goal(+Query, +Module, -Goal) is nondet: Query, or a goal that it calls.

goal(Query, _, Query) :-
    callable(Query).
goal(Query, Module, Goal) :-
    callable(Query),
    Query \= _:_,
    predicate_property(Module:Query, meta_predicate(Spec)),
    arg(I, Spec, 0),
    arg(I, Query, Argument),
    goal(Argument, Module, Goal).

word(PI) :-
    member(Module, [typhon_words, typhon_memory, typhon_seals]),
    module_property(Module, exports(PIs)),
    memberchk(PI, PIs).

%!  word_told(+Spec, -Text, ?Rest) is semidet.
%
%   The text for an unknown procedure Spec that is a word of agents.

word_told(Spec) -->
    { own_module(Spec, PI),
      word(PI)
    },
    [ 'Unknown procedure: ~p: the program of an agent can call it'-[PI] ],
    instead(PI).

own_module(Name/Arity, Name/Arity).
own_module(user:PI, PI).

instead(PI) -->
    { outside(PI, Text) },
    !,
    [ '; from outside it is ~w'-[Text] ].
instead(_) -->
    [].

%   outside(+PI, -Text): what does the same from outside.

outside(move/1, 'agent_move(Agent, Host)').
outside(clone/1, 'agent_clone(Agent, Clone)').
outside(clone/2, 'agent_clone(Agent, Clone)').
outside(send/2, 'agent_send(Agent, Message)').
outside(dispose/0, 'agent_dispose(Agent)').
outside(attach/1, 'payload_attach(Agent, Payload)').
outside(detach/1, 'payload_detach(Agent, Name)').
outside(result/1, 'agent_result(Agent, Term, Timeout)').
outside(home/1, 'agent_property(Agent, home(Host))').
outside(here/1, 'agent_property(Agent, host(Host))').
outside(hops/1, 'agent_property(Agent, hops(Count))').
outside(neighbours/1, 'host_property(Host, neighbours(Hosts))').
outside(host_load/1, 'host_property(Host, load(Count))').
outside(PI, Text) :-
    member(PI, [leave/1, leave_new/1, sense/1, take/1, now/1, emit/1, emit/2,
                withdraw/1, pheromone/3]),
    PI = Name/Arity,
    length(Arguments, Arity),
    maplist(=('_'), Arguments),
    Goal =.. [Name|Arguments],
    format(atom(Text), 'remote(Host, ~w)', [Goal]).

                /*******************************
                *           EDITORS            *
                *******************************/

%!  directive_meant(+Directive, -Directives) is semidet.
%
%   Directive is a declaration of an agent or payload and stands for
%   Directives.

directive_meant(Directive, Directives) :-
    declared(Directive, Kind, Options),
    findall((:- Meant), meant(Kind, Options, Meant), Directives).

declared(Directive, Kind, Options) :-
    predicates_option(Kind, _, _),
    declaration(Kind, (:- Directive), _, Options),
    !.

meant(_, _, use_module(File)) :-
    words_file(File).
meant(agent, _, public([main/0, on_message/2])).
meant(Kind, Options, Meant) :-
    predicates_option(Kind, PIs, Option),
    member(Option, Options),
    findall(PI, indicator_in(PIs, PI), List),
    (   Meant = dynamic(List)
    ;   Kind == payload,
        Meant = public(List)            % agents that have it may call them
    ).

predicates_option(agent, PIs, state(PIs)).
predicates_option(payload, PIs, provides(PIs)).

%!  words_file(?File) is nondet.
%
%   File defines predicates that agents can call.

words_file(File) :-
    member(Module, [typhon_words, typhon_memory]),
    module_property(Module, file(File)).

%!  directive_coloured(+Directive, -Colours) is semidet.
%
%   As prolog_colour:directive_colours/2.

directive_coloured(Directive, built_in-Arguments) :-
    declared(Directive, Kind, Options),
    (   Options == []
    ->  Arguments = [identifier,classify]
    ;   findall(Colours, option_colours(Kind, Options, Colours), List),
        Arguments = [identifier,list-List]
    ).

option_colours(Kind, Options, Colours) :-
    member(Option, Options),
    (   predicates_option(Kind, _, Known),
        subsumes_term(Known, Option)
    ->  Colours = functor-[predicates]
    ;   Colours = type_error(option)
    ).
