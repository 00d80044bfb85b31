:- module(site_colour,
          [ code_dom/3                  % +Kind, +Text, -Dom
          ]).

/** <module> Code in colours

As SWI-Prolog's own library(prolog_colour) sees it. Which colour a class has
is said in style.css.

*Threading*: any thread.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, append/3]).
:- use_module(library(prolog_colour), [prolog_colourise_stream/3]).

:- thread_local range/3.                % Start, Length, Class

%!  code_dom(+Kind, +Text:string, -Dom) is det.
%
%   Kind is `prolog`, `'prolog-session'` or anything else.

code_dom(prolog, Text, Dom) :-
    !,
    setup_call_cleanup(
        open_string(Text, In),
        prolog_colourise_stream(In, site_code, note),
        close(In)),
    findall(Start-range(Length, Class), retract(range(Start, Length, Class)),
            Ranges0),
    keysort(Ranges0, Ranges),
    paint(Ranges, 0, Text, Dom).
code_dom('prolog-session', Text, Dom) :-
    !,
    split_string(Text, "\n", "", Lines0),
    append(Lines, [_], Lines0),         % after the last line end
    maplist(session_line, Lines, Doms),
    append(Doms, Dom).
code_dom(_, Text, [Text]).

note(Colour, Start, Length) :-
    (   class(Colour, Class)
    ->  assertz(range(Start, Length, Class))
    ;   true
    ).

class(goal(_, Goal), goal(Name/Arity)) :-
    callable(Goal),
    functor(Goal, Name, Arity).
class(comment(_), comment).
class(var, var).
class(singleton, var).
class(string, text).
class(quoted_atom, text).
class(head(_, _), head).
class(int, number).
class(float, number).

%   paint(+Ranges, +At, +Text, -Dom): ranges do not overlap, but for a
%   comment that is seen twice.

paint([], At, Text, [Rest]) :-
    sub_string(Text, At, _, 0, Rest).
paint([Start-range(Length, Class)|Ranges], At, Text, Dom) :-
    (   Start < At
    ->  paint(Ranges, At, Text, Dom)
    ;   Before is Start-At,
        sub_string(Text, At, Before, _, Plain),
        sub_string(Text, Start, Length, _, Painted),
        End is Start+Length,
        painted(Class, Painted, Node),
        Dom = [Plain, Node|More],
        paint(Ranges, End, Text, More)
    ).

%   Names of goals are left to links.pl, which knows what is public.

painted(goal(Name/Arity), Text, element(code, [name=PI], [Text])) :-
    !,
    atomic_list_concat([Name, Arity], /, PI).
painted(Class, Text, element(span, [class=Class], [Text])).

session_line(Line, [element(b, [], [Line]), "\n"]) :-
    sub_string(Line, 0, _, _, "?- "),
    !.
session_line("", ["\n"]) :-
    !.
session_line(Line, [element(span, [class=answer], [Line]), "\n"]).
