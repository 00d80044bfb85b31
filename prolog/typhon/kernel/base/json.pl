:- module(typhon_json,
          [ json_dict/2,                % +Text, -Term
            json_text/2                 % +Term, -Text
          ]).

/** <module> JSON by the library of this SWI-Prolog

That is library(http/json) until SWI-Prolog 9.3, and library(json) since.  The
newer versions print a message where the old name is loaded.

*Threading*: no state.
*/

:- if(exists_source(library(json))).
:- reexport(library(json), [atom_json_dict/3, json_read_dict/2]).
:- else.
:- reexport(library(http/json), [atom_json_dict/3, json_read_dict/2]).
:- endif.

%!  json_text(+Term, -Text:string) is det.
%
%   One line; Term is as in json_write_dict/3.

json_text(Term, Text) :-
    atom_json_dict(Text, Term, [as(string), width(0)]).

%!  json_dict(+Text, -Term) is det.
%
%   Term is the value of the JSON text: dicts, none with a tag, lists, strings,
%   numbers, `true`, `false` and `null`.
%
%   @error syntax_error(json(Problem))

:- if(exists_source(library(json))).
json_dict(Text, Term) :-
    atom_json_dict(Text, Term, [default_tag(_)]).
:- else.
json_dict(Text, Term) :-
    atom_json_dict(Text, Term, []).
:- endif.
