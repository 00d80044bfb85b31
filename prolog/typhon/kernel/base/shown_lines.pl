:- module(typhon_shown_lines,
          [ shown_lines/2               % +Lines0, -Lines
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, memberchk/2]).
:- use_module(text, [formatted/3, lines_shown/2]).

/** <module> Messages that hold text from elsewhere

A clause of prolog:message//1, which comes first, translates messages of this
library and errors by the other clauses, and writes characters that control the
terminal, or hide text, as escape sequences.  So texts of messages
may use ~w and ~p for any term.  Errors of SWI-Prolog are included, since an
agent or a peer may have raised them.

*Threading*: pure, except for a variable of the thread.
*/

:- multifile
    prolog:message//1,
    prolog:message_line_element/2.

prolog:message(Term) -->
    typhon_shown_lines:filtered(Term).

:- public filtered//1.

%   filtered(+Term)//: fails while it runs, so that the other clauses translate.

filtered(Term, Lines, Rest) :-
    passes(Term),
    \+ nb_current(typhon_filtering, true),
    b_setval(typhon_filtering, true),
    prolog:translate_message(Term, Lines0, []),
    b_setval(typhon_filtering, false),
    !,
    shown_lines(Lines0, Shown),
    append(Shown, Rest, Lines).

passes(typhon(_)).
passes(error(_, _)).
passes(unhandled_exception(_)).

%   library(debug) translates messages of debug/3 itself.  Their arguments may
%   hold newlines.

prolog:message_line_element(Out, Format-Args) :-
    nb_current(prolog_debug_printing, true),
    catch(format(string(Text0), Format, Args), error(_, _), fail),
    lines_shown(Text0, Text),
    write(Out, Text).

%!  shown_lines(+Lines0:list, -Lines:list) is det.
%
%   Lines are the message lines Lines0 with escape sequences, see shown_text/2.
%   Elements without such text are the same in both.

shown_lines(Lines0, Lines) :-
    maplist(shown_element, Lines0, Lines).

shown_element(Element0, Element) :-
    nonvar(Element0),
    parts(Element0, Format, Args, Other, Text),
    catch(( format(string(Text0), Format, Args),
            formatted(Format, Args, Text) ),
          error(_, _), fail),           % print_message/2 reports that
    Text \== Text0,
    !,
    Element = Other.
shown_element(Element, Element).

%   parts(+Element, -Format, -Args, -Other, -Text): Element prints Args by
%   Format; Other prints Text instead.

parts(Format-Args, Format, Args, '~w'-[Text], Text) :- !.
parts(ansi(Style, Format, Args), Format, Args, ansi(Style, '~w', [Text]),
      Text) :- !.
parts(url(Place), '~w', [Place], '~w'-[Text], Text) :- !.
parts(url(Place, Label), '~w ~w', [Place, Text0], '~w'-[Text], Text) :-
    !,
    ( Label = Format-Args -> format(string(Text0), Format, Args)
    ; Text0 = Label ).
parts(Format, Format, [], '~w'-[Text], Text) :-
    ( atom(Format) ; string(Format) ),
    \+ memberchk(Format, [nl, flush, full_stop, at_same_line]).
