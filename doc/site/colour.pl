:- module(site_colour,
          [ code_html/4                 % +Kind, +Text, +Site, -Html
          ]).

/** <module> Code in colours

As SWI-Prolog's own library(prolog_colour) sees it. Which colour a class has
is said in style.css.

*Threading*: any thread.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(prolog_colour), [prolog_colourise_stream/3]).
:- use_module(library(sgml), [xml_quote_cdata/3]).

:- thread_local range/3.                % Start, Length, Class

%!  code_html(+Kind, +Text:string, +Site, -Html:string) is det.
%
%   Kind is `prolog` or `'prolog-session'`; Site is site(Root, Public), the way
%   to the root of the site, and the predicates of its reference.

code_html(Kind, Text, Site, Html) :-
    painted(Kind, Text, Site, Parts),
    atomic_list_concat(Parts, Inside),
    format(string(Html), '<pre class="~w"><code>~w</code></pre>~n',
           [Kind, Inside]).

painted(prolog, Text, Site, Parts) :-
    setup_call_cleanup(
        open_string(Text, In),
        prolog_colourise_stream(In, site_code, note),
        close(In)),
    findall(Start-range(Length, Class), retract(range(Start, Length, Class)),
            Ranges0),
    keysort(Ranges0, Ranges),
    paint(Ranges, 0, Text, Site, Parts).
painted('prolog-session', Text, _, Parts) :-
    split_string(Text, "\n", "", Lines0),
    append(Lines, [_], Lines0),         % after the last line end
    maplist(session_line, Lines, Parts).

note(Colour, Start, Length) :-
    (   class(Colour, Class)
    ->  assertz(range(Start, Length, Class))
    ;   true
    ).

class(goal(_, Goal), goal(PI)) :-
    callable(Goal),
    functor(Goal, Name, Arity),
    atomic_list_concat([Name, Arity], /, PI).
class(comment(_), comment).
class(var, var).
class(singleton, var).
class(string, text).
class(quoted_atom, text).
class(head(_, _), head).
class(int, number).
class(float, number).

%   paint(+Ranges, +At, +Text, +Site, -Parts): ranges do not overlap, but for a
%   comment that is seen twice.

paint([], At, Text, _, [Rest]) :-
    sub_string(Text, At, _, 0, Rest0),
    quoted(Rest0, Rest).
paint([Start-range(Length, Class)|Ranges], At, Text, Site, Parts) :-
    (   Start < At
    ->  paint(Ranges, At, Text, Site, Parts)
    ;   Before is Start-At,
        sub_string(Text, At, Before, _, Plain0),
        sub_string(Text, Start, Length, _, Range0),
        quoted(Plain0, Plain),
        quoted(Range0, Range),
        coloured(Class, Range, Site, Painted),
        Parts = [Plain, Painted|More],
        End is Start+Length,
        paint(Ranges, End, Text, Site, More)
    ).

coloured(goal(PI), Text, site(Root, Public), Html) :-
    !,
    (   memberchk(PI, Public)
    ->  format(string(Html), '<a href="~wpredicates.html#~w">~w</a>',
               [Root, PI, Text])
    ;   Html = Text
    ).
coloured(Class, Text, _, Html) :-
    format(string(Html), '<span class="~w">~w</span>', [Class, Text]).

session_line(Line0, Html) :-
    quoted(Line0, Line),
    (   sub_string(Line0, 0, _, _, "?- ")
    ->  format(string(Html), '<b>~w</b>~n', [Line])
    ;   format(string(Html), '<span class="answer">~w</span>~n', [Line])
    ).

quoted(Text, Quoted) :-
    xml_quote_cdata(Text, Quoted, utf8).
