:- module(typhon_page_terms,
          [ read_text/3,                % +Field, +Text, -Term
            text_in/3,                  % +Key, +Message, -Text
            name_in/3,                  % +Key, +Message, -Name
            term_in/4                   % +Key, +Message, +Default, -Term
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).

/** <module> What is in a message from a browser

*Threading*: pure.
*/

:- multifile
    prolog:error_message//1.

%!  text_in(+Key, +Message:dict, -Text:string) is det.
%!  name_in(+Key, +Message:dict, -Name:atom) is det.
%!  term_in(+Key, +Message:dict, +Default, -Term) is det.
%
%   What stands in Message under Key; a term is read as Prolog, and where it is
%   missing or empty it is Default.
%
%   @error existence_error(page_field, Key), page_syntax(Key, Error)

text_in(Key, Message, Text) :-
    (   get_dict(Key, Message, Text0)
    ->  must_be(string, Text0),
        Text = Text0
    ;   existence_error(page_field, Key)
    ).

name_in(Key, Message, Name) :-
    text_in(Key, Message, Text),
    (   Text == ""
    ->  existence_error(page_field, Key)
    ;   atom_string(Name, Text)
    ).

term_in(Key, Message, Default, Term) :-
    (   get_dict(Key, Message, Text),
        must_be(string, Text),
        split_string(Text, " \n\t", " \n\t", Parts),
        Parts \== [""]
    ->  read_text(Key, Text, Term)
    ;   nonvar(Default)
    ->  Term = Default
    ;   existence_error(page_field, Key)
    ).

%!  read_text(+Field, +Text, -Term) is det.

read_text(Field, Text, Term) :-
    catch(term_string(Term, Text),
          error(syntax_error(Error), Where),
          throw(error(page_syntax(Field, syntax_error(Error), Where), _))).

prolog:error_message(page_syntax(Field, Error, Where)) -->
    { message_to_text(Error, Text),
      place_text(Where, Place)
    },
    [ 'the ~w cannot be read: ~w~w'-[Field, Text, Place] ].
prolog:error_message(existence_error(page_field, Field)) -->
    [ 'the ~w is missing'-[Field] ].

message_to_text(Error, Text) :-
    phrase(prolog_message_of(Error), Lines),
    with_output_to(string(Text0),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text0, "", " \n", [Text]).

prolog_message_of(syntax_error(Error)) -->
    '$messages':syntax_error(Error).

%   From where on it makes no sense.

place_text(string(Text, Position), Place) :-
    integer(Position),
    !,
    string_length(Text, Length),
    At is min(Position, Length),
    Start is max(0, At-20),
    Count is At-Start,
    sub_string(Text, Start, Count, _, Before),
    sub_string(Text, At, _, 0, After0),
    split_string(After0, "", " .", [After]),
    format(string(Place), ', at "~w ** here ** ~w"', [Before, After]).
place_text(stream(_, Line, Column, _), Place) :-
    !,
    format(string(Place), ', at line ~w, column ~w', [Line, Column]).
place_text(_, '').
