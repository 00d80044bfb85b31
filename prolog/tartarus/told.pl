:- module(tartarus_told,
          [ told/2,                     % +Format, +Arguments
            verbosely/2,                % +Format, +Arguments
            verbosity/1,                % ?Bit
            set_verbosity/1,            % +Bit
            wrong/2,                    % +Format, +Arguments
            must/1                      % :Checks
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).

/** <module> What platforms print

Programs and people rely on some of the texts.  Errors go to the standard
error and are followed by failure, success, or, where arguments are checked,
by an abort, as it was.
*/

:- meta_predicate must(:).

:- dynamic verbosity/1.

verbosity(0).

%!  told(+Format, +Arguments) is det.
%!  verbosely(+Format, +Arguments) is det.
%
%   Print a line, or more, as format/2; the latter if the platform is verbose.

told(Format, Arguments) :-
    format(user_output, Format, Arguments),
    flush_output(user_output).

verbosely(Format, Arguments) :-
    (   verbosity(1)
    ->  told(Format, Arguments)
    ;   true
    ).

%!  verbosity(?Bit) is semidet.
%!  set_verbosity(+Bit) is det.
%
%   0 or 1.

set_verbosity(Bit) :-
    retractall(verbosity(_)),
    assertz(verbosity(Bit)).

%!  wrong(+Format, +Arguments) is det.
%
%   Say on the standard error what is wrong.

wrong(Format, Arguments) :-
    print_message(error, format(Format, Arguments)).

%!  must(:Checks) is det.
%
%   Checks is a list of check(Code, Text, Goal).  Those whose Goal fails are
%   told, then the thread that calls is aborted.

must(Module:Checks) :-
    findall(Code-Text,
            ( member(check(Code, Text, Goal), Checks), \+ Module:Goal ),
            Errors),
    (   Errors == []
    ->  true
    ;   maplist(told_error, Errors),
        length(Errors, Count),
        told("errors found: ~d~n", [Count]),
        abort
    ).

told_error(Code-Text) :-
    told("Error# ~w: ~w~n", [Code, Text]).
