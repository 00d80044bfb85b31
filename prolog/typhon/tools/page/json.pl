:- module(typhon_page_json,
          [ json_text/2                 % +Term, -Text
          ]).

/** <module> JSON as one line of text

*Threading*: pure.
*/

:- if(exists_source(library(json))).
:- use_module(library(json), [json_write_dict/3]).
:- else.
:- use_module(library(http/json), [json_write_dict/3]).
:- endif.

%!  json_text(+Term, -Text:string) is det.
%
%   Term is made of dicts, lists, strings and numbers, as json_write_dict/3
%   takes it.

json_text(Term, Text) :-
    with_output_to(string(Text),
                   json_write_dict(current_output, Term, [width(0)])).
