:- module(typhon_variants,
          [ place_variant/3,            % +Place, -View, -Variant
            agent_variant/2             % +Module, -Variant
          ]).
:- use_module('../host', [parts/3, place_host/2]).

/** <module> Variants: hosts that run programs otherwise than as written

An option may rewrite what agents bring to a host, for example to check what
they call.  Then an agent does not hang below the place of the host, but below
a view of it, a module that the option has made: the part of the host in the
phase `view`, see typhon_host_parts.  The option defines the hooks

    variant(View, Variant)      agents that hang below View have this variant,
                                a term that the option knows
    program(Variant, Hash, Module)
                                Module has the installed program of that hash
    state(Variant, State0, State)
    goals(Variant, Program, Goals0, Goals)
                                an agent with the program in the module
                                Program comes with State0 and Goals0
    clauses(Variant, Clauses0, Clauses)
                                clauses are added to its state
    declares(Variant, PI)       a payload provides PI
    called(Variant, Module, Closure, Extra, Goal)
                                Goal is what the agent in Module calls by
                                '$checked'(Closure, Extra, ...)

They raise errors to refuse it.  An agent keeps its variant while it stays on
the host, whatever becomes of the options of the host.

*Threading*: any thread.
*/

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

%!  place_variant(+Place, -View, -Variant) is semidet.
%
%   What agents hang below that come to Place now.  Fails for places where
%   programs run as they are.

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
