:- module(typhon_language,
          [ advice_text/2,              % +Advice, -Text
            declaration/4,              % +Kind, +Term, -Name, -Options
            file_parts/4,               % +Kind, +Located, -Parts, -Problems
            files_beside/3,             % +File, +Dir, -Files
            in_file_order/3,            % +Problems, +Located, -Ordered
            library_directive/2,        % +Parts, -Library
            library_export/2,           % +Library, ?Export
            part/3,                     % +What, +Parts, -Value
            payload_terms/3,            % +Located, -Payload, -Errors
            problem_error/3,            % +Problem, +Others, -Error
            program_terms/6,            % +Located, -Program, -Initial, -Kinds,
                                        % -Places, -Errors
            source_clause/2,            % +Location, -Clause
            source_same/1,              % +Sources
            source_terms/5              % +Spec, -Located, -Sources, -Errors,
                                        % -Warnings
          ]).
:- reexport(language/library_data, [library_export/2]).
:- reexport(language/programs,
            [ advice_text/2, file_parts/4, in_file_order/3,
              library_directive/2, part/3, payload_terms/3, problem_error/3,
              program_terms/6 ]).
:- reexport(language/source,
            [ declaration/4, files_beside/3, source_clause/2, source_same/1,
              source_terms/5 ]).

/** <module> The language of programs

Clause files are read and checked here.  A process that creates no agent from a
program needs none of this.  The kernel loads it by module `typhon_reading`,
tools import this interface by autoload/2, which reads the names from its list
of exports.

*Threading*: any thread.
*/
