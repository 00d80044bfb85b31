:- module(typhon_abridged,
          [ abridged/3                  % +Term, +Longest, -Text
          ]).
:- use_module(library(apply), [maplist/2]).

/** <module> Terms as text that has an end

*Threading*: pure.
*/

%!  abridged(+Term, +Longest:integer, -Text:string) is det.
%
%   Text is Term as it would be written in a program, variables as `_` where
%   they occur once and letters elsewhere.  Of more than Longest characters
%   only the beginning is there, and three dots after it.  What is deep or
%   cyclic is cut off on the way, so that a large term costs no more than its
%   text.

abridged(Term, Longest, Text) :-
    copy_term(Term, Copy, _),
    named(Copy),
    Depth is max(10, Longest),
    format(string(Whole), '~W',
           [ Copy, [ quoted(true), numbervars(true), portray(false),
                     max_depth(Depth), cycles(true) ] ]),
    (   sub_string(Whole, 0, Longest, After, Begin),
        After > 3
    ->  string_concat(Begin, "...", Text)
    ;   Text = Whole
    ).

named(Term) :-
    cyclic_term(Term),
    !.
named(Term) :-
    term_singletons(Term, Singletons),
    maplist(=('$VAR'('_')), Singletons),
    numbervars(Term, 0, _).
