:- module(typhon_fipa_multipart,
          [ multipart_read/3,           % +ContentType, +Body, -Parts
            multipart_write/3           % +Parts, -ContentType, -Body
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(random), [random_between/3]).

/** <module> The two parts of a message

A message travels as multipart/mixed (RFC 2046): its envelope and its text.
Bodies are strings of bytes; a part is Type-Bytes.

*Threading*: pure, but for the boundary, which is drawn.
*/

%   For each part the rest is copied.

max_parts(16).

%!  multipart_read(+ContentType:text, +Body:string, -Parts:list(pair)) is det.
%
%   @error syntax_error(fipa_multipart)

multipart_read(ContentType, Body, Parts) :-
    (   boundary(ContentType, Boundary),
        string_concat("\n--", Boundary, Mark),
        string_concat("\n", Body, Text),
        max_parts(Most),
        split(Text, Mark, Most, [_|Pieces0]),
        append(Pieces, [End], Pieces0),
        sub_string(End, 0, 2, _, "--"),
        maplist(piece_part, Pieces, Parts0)
    ->  Parts = Parts0
    ;   syntax_error(fipa_multipart)
    ).

boundary(ContentType, Boundary) :-
    split_string(ContentType, ";", " \t", [Type|Parameters]),
    string_lower(Type, "multipart/mixed"),
    member(Parameter, Parameters),
    sub_string(Parameter, Before, 1, After, "="),
    sub_string(Parameter, 0, Before, _, Name),
    string_lower(Name, "boundary"),
    !,
    sub_string(Parameter, _, After, 0, Quoted),
    split_string(Quoted, "", "\"", [Boundary]),
    string_length(Boundary, Length),
    Length > 0,
    Length =< 70.

%   The line break before a boundary belongs to it.

split(Text, Mark, Most, [Piece|Pieces]) :-
    sub_string(Text, Before, _, After, Mark),
    !,
    Most > 0,
    Less is Most-1,
    sub_string(Text, 0, Before, _, Piece),
    sub_string(Text, _, After, 0, Rest),
    split(Rest, Mark, Less, Pieces).
split(Text, _, _, [Text]).

%   A piece begins with the end of the line of its boundary.

piece_part(Piece0, Type-Bytes) :-
    without_return(Piece0, Piece),
    (   head_end(Piece, "\r\n\r\n", Head, Bytes0)
    ->  true
    ;   head_end(Piece, "\n\n", Head, Bytes0)
    ),
    Bytes = Bytes0,
    content_type(Head, Type).

without_return(Piece0, Piece) :-
    (   string_concat(Piece, "\r", Piece0)
    ->  true
    ;   Piece = Piece0
    ).

head_end(Piece, Mark, Head, Bytes) :-
    sub_string(Piece, Before, _, After, Mark),
    !,
    sub_string(Piece, 0, Before, _, Head),
    sub_string(Piece, _, After, 0, Bytes).

content_type(Head, Type) :-
    split_string(Head, "\n", " \t\r", Lines),
    member(Line, Lines),
    sub_string(Line, Before, 1, After, ":"),
    sub_string(Line, 0, Before, _, Name),
    string_lower(Name, "content-type"),
    !,
    sub_string(Line, _, After, 0, Value),
    split_string(Value, ";", " \t", [Type0|_]),
    string_lower(Type0, Lower),
    atom_string(Type, Lower).
content_type(_, 'text/plain').

%!  multipart_write(+Parts, -ContentType:string, -Body:string) is det.

multipart_write(Parts, ContentType, Body) :-
    Most is 1<<96,
    random_between(0, Most, Drawn),
    format(string(Boundary), 'typhon-~36r', [Drawn]),
    format(string(ContentType), 'multipart/mixed ; boundary="~w"',
           [Boundary]),
    with_output_to(string(Body), write_parts(Parts, Boundary)).

write_parts([], Boundary) :-
    format('--~w--\r\n', [Boundary]).
write_parts([Type-Bytes|Parts], Boundary) :-
    format('--~w\r\nContent-Type: ~w\r\n\r\n~s\r\n', [Boundary, Type, Bytes]),
    write_parts(Parts, Boundary).
