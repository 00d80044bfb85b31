:- module(experiment_command,
          [ command/5,                  % +Positional, +Given, +Defaults,
                                        % :Check, :Run
            acceptable/3,               % :Goal, +Domain, +Value
            range/1                     % ?Range
          ]).
:- use_module(signals, [stopping_on_signals/1]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [selectchk/3]).

/** <module> Experiments as commands of the shell

*Threading*: the main thread.
*/

:- meta_predicate
    command(+, +, +, 1, 1),
    acceptable(0, +, +).

%!  command(+Positional, +Given, +Defaults, :Check, :Run) is det.
%
%   Calls Run(Options), once Check(Options) has not complained. Positional
%   and Given are what argv_options/3 has found; Positional must be empty.
%   Options are Defaults, a list of Name(Value), with those replaced that
%   are Given: of one that is given twice the last counts. The process ends
%   in order on a signal, and with status 1 after an error.
%
%   @see stopping_on_signals/1

command(Positional, Given, Defaults, Check, Run) :-
    set_stream(user_output, encoding(utf8)),
    set_stream(user_error, encoding(utf8)),
    foldl(give, Given, Defaults, Options),
    catch(( acceptable(Positional == [], option, Positional),
            call(Check, Options),
            stopping_on_signals(call(Run, Options))
          ),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            halt(1)
          )).

give(Option, Options0, [Option|Options]) :-
    functor(Option, Name, 1),
    functor(Default, Name, 1),
    selectchk(Default, Options0, Options).

%!  acceptable(:Goal, +Domain, +Value) is det.
%
%   Goal holds of Value.
%
%   @error domain_error(Domain, Value)

acceptable(Goal, _, _) :-
    call(Goal),
    !.
acceptable(_, Domain, Value) :-
    domain_error(Domain, Value).

%!  range(?Range) is semidet.
%
%   Range is Min-Max, numbers not below 0.

range(Range) :-
    nonvar(Range),
    Range = Min-Max,
    number(Min),
    number(Max),
    0 =< Min,
    Min =< Max.
